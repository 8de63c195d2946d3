#include "ricochet/mass/mass.hpp"

#include <algorithm>

#include "bindings.hpp"

namespace ricochet::python {

namespace {

/// Returns (name of the construction used, its reason, parts of the matrix).
py::tuple build(const std::string& type, const Numbers& data, const Indices& indices, const Indices& starts, Index size,
                const Numbers& nodes, std::vector<Index> contact_nodes,
                const std::map<std::string, double>& parameters) {
  const SparseMatrix consistent = sparse_matrix(data, indices, starts, size);
  const Points places = Eigen::Map<const Points>(nodes.data(), nodes.shape(1), nodes.shape(0));
  Parameters given;
  for (const auto& [name, value] : parameters) given.set(name, value);
  MassInput input;
  input.consistent = &consistent;
  input.nodes = &places;
  input.contact_nodes = std::move(contact_nodes);
  MassChoice choice;
  SparseMatrix mass;
  {
    const py::gil_scoped_release unlocked;
    choice = mass_to_build(type, given, input);
    mass = choice.mass ? std::move(*choice.mass) : build_mass(choice.name, input, choice.parameters);
  }
  return py::make_tuple(choice.name, choice.reason, parts_of(std::move(mass)));
}

}  // namespace

void bind_mass(py::module_& module) {
  module.def("build_mass", &build, py::arg("type"), py::arg("data"), py::arg("indices"), py::arg("starts"),
             py::arg("size"), py::arg("nodes"), py::arg("contact_nodes"), py::arg("parameters"));
}

}  // namespace ricochet::python
