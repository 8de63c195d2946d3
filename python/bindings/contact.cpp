#include <fmt/format.h>

#include "bindings.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"

namespace ricochet::python {

namespace {

/// A solver with the problem that it has analysed.
struct OpenSolver {
  std::unique_ptr<ContactSolver> solver;
  ContactProblem problem;
  ContactSolution solution;

  OpenSolver(const std::string& name, Index dimension, std::shared_ptr<const ContactOperator> w, const Vector& friction,
             const Vector& bound)
      : solver(make_contact_solver(name)), problem(dimension, w, Vector::Zero(w->rows()), friction) {
    problem.friction_bound = bound;
    const py::gil_scoped_release unlocked;
    solver->analyse(problem);
  }
};

const char* word(ContactOutcome outcome) {
  switch (outcome) {
    case ContactOutcome::solved:
      return "solved";
    case ContactOutcome::not_converged:
      return "not converged";
    case ContactOutcome::not_applicable:
      return "not applicable";
    case ContactOutcome::invalid_data:
      return "invalid data";
  }
  return "";
}

std::shared_ptr<const ContactOperator> dense(const Numbers& w) {
  if (w.ndim() != 2 || w.shape(0) != w.shape(1))
    throw Error(ErrorKind::invalid_input, "contact: W must be a square matrix");
  return make_dense_operator(Eigen::Map<const Matrix>(w.data(), w.shape(0), w.shape(0)));
}

std::shared_ptr<const ContactOperator> known_by_product(Index rows, py::function product) {
  // Python objects are released with Python's lock held.
  const std::shared_ptr<py::function> kept(new py::function(std::move(product)), [](py::function* object) {
    const py::gil_scoped_acquire lock;
    delete object;
  });
  return make_product_operator(rows, [kept](const Vector& x, Vector& y) {
    const py::gil_scoped_acquire lock;
    const Numbers result = (*kept)(view(x.data(), x.size(), 0, py::none()));
    y = vector_of(result);
  });
}

py::dict solve(OpenSolver& open, const Numbers& offset, double tolerance, int iteration_limit) {
  open.problem.offset = vector_of(offset);
  {
    const py::gil_scoped_release unlocked;
    open.solver->solve(open.problem, {.tolerance = tolerance, .iteration_limit = iteration_limit}, open.solution);
  }
  const ContactSolution& found = open.solution;
  py::dict result;
  const auto points = Index(found.status.size());
  const Index rows = found.reaction.size() / std::max<Index>(points, 1);
  result["reaction"] = owned_array(Vector(found.reaction), points, rows);
  result["motion"] = owned_array(Vector(found.motion), points, rows);
  result["status"] = numbers_of(found.status);
  result["outcome"] = word(found.outcome);
  result["reason"] = found.reason;
  result["contradiction"] = found.contradiction;
  result["residual"] = found.residual;
  result["rounding_floor"] = found.rounding_floor;
  result["iterations"] = found.iterations;
  result["newton_steps"] = found.newton_steps;
  return result;
}

}  // namespace

void bind_contact(py::module_& module) {
  py::class_<ContactOperator, std::shared_ptr<ContactOperator>>(module, "ContactOperator");
  module.def("dense_operator", [](const Numbers& w) { return std::const_pointer_cast<ContactOperator>(dense(w)); });
  module.def("sparse_operator", [](const Numbers& data, const Indices& indices, const Indices& starts, Index size) {
    return make_sparse_operator(sparse_matrix(data, indices, starts, size));
  });
  module.def("product_operator", [](Index rows, py::function product) {
    return std::const_pointer_cast<ContactOperator>(known_by_product(rows, std::move(product)));
  });
  py::class_<OpenSolver>(module, "ContactSolver")
      .def(py::init([](const std::string& name, Index dimension, std::shared_ptr<ContactOperator> w,
                       const Numbers& friction, const Numbers& bound) {
             return std::make_unique<OpenSolver>(name, dimension, std::move(w), vector_of(friction), vector_of(bound));
           }),
           py::arg("name"), py::arg("dimension"), py::arg("operator"), py::arg("friction"), py::arg("bound"))
      .def("solve", &solve, py::arg("offset"), py::arg("tolerance"), py::arg("iteration_limit"))
      .def("set_warm_start",
           [](OpenSolver& open, const Numbers& reactions) { open.solver->set_warm_start(vector_of(reactions)); });
}

}  // namespace ricochet::python
