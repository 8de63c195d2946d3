#include "ricochet/run/session.hpp"

#include <fmt/format.h>

#include <atomic>
#include <utility>

#include "bindings.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/contact_export.hpp"
#include "ricochet/io/summary.hpp"

namespace ricochet::python {

namespace {

/// Seconds between two updates of the progress.
constexpr double progress_interval = 0.1;

/// A session, and its state in Python.
class OpenSession {
 public:
  OpenSession(Case input, std::vector<std::string> remarks) : session(std::move(input), std::move(remarks)) {}

  /// Calls functions that may take time without Python's lock. Sessions on several threads run one after the other.
  /// Throws Error(usage) if another thread is in such a call of this session.
  template <class Work>
  auto alone(const Work& work) {
    if (is_busy_.exchange(true)) refuse_other_thread();
    const struct End {
      std::atomic<bool>& is_busy;
      ~End() { is_busy = false; }
    } end{is_busy_};
    const LibraryLock lock;
    return work();
  }
  [[nodiscard]] const SemidiscreteProblem& problem() {
    if (has_problem) return check_thread(), session.problem();
    alone([this] { (void)session.problem(); });
    has_problem = true;
    return session.problem();
  }
  [[nodiscard]] Simulation& simulation() {
    if (has_state) return check_thread(), session.simulation();
    alone([this] { (void)session.simulation(); });
    has_problem = has_state = true;
    return session.simulation();
  }
  [[nodiscard]] const State& state() { return simulation().state(); }

  /// Throws if a step was refused before the end of the run: a loop until the end must not continue for ever.
  void explain_end() {
    if (!writes || session.is_complete_already() || session.at_end()) return signals.raise();
    finished = finish();  // throws the error that ended the steps; a signal is no error
    signals.raise();
    throw Error(ErrorKind::not_converged, "session: the run has ended");
  }

  bool step() {
    if (alone([this] { return session.step(); })) return true;
    explain_end();
    return false;
  }

  /// Computes all remaining steps, or until `each` returns False.
  void run(const py::object& each, const py::object& progress) {
    const Timer clock;
    double shown = 0.0;
    while (step()) {
      if (!progress.is_none() && clock.seconds() - shown >= progress_interval) {
        shown = clock.seconds();
        progress(session.state().step, session.time());
      }
      if (!each.is_none()) {
        const py::object answer = each();
        if (py::isinstance<py::bool_>(answer) && !answer.cast<bool>()) return;
      }
      // A session that writes checks for signals itself, and leaves a checkpoint.
      if (!writes && signals() != 0) signals.raise();
    }
  }

  /// Computes so many steps, to measure the overhead of Python.
  void take_steps(long count) {
    alone([this, count] {
      for (long k = 0; k < count; ++k) (void)session.step();
    });
  }

  std::string finish() {
    if (!finished.empty()) return std::exchange(finished, {});  // a signal has ended it already
    writes = false;
    return alone([this] { return to_json(session.finish()); });
  }

  Session session;
  SignalCheck signals;
  std::string finished;  ///< the summary of a run that a signal has ended
  bool writes = false;
  bool has_problem = false, has_state = false;

 private:
  [[noreturn]] static void refuse_other_thread() {
    throw Error(ErrorKind::usage, "session: another thread is using it; wait until its call has returned");
  }
  void check_thread() const {
    if (is_busy_) refuse_other_thread();
  }

  std::atomic<bool> is_busy_ = false;
};

/// Returns the number of nodes of cells; those of rigid bodies follow them and are shown as obstacles.
Index nodes_of(const SemidiscreteProblem& problem) { return problem.cell_node_count(); }

/// Returns a vector of the state as nodes × dimension.
template <class Choose>
auto nodal(const Choose& choose) {
  return [choose](const py::object& self) {
    auto& open = self.cast<OpenSession&>();
    const State& state = open.state();
    return view(choose(state).data(), nodes_of(open.session.problem()), open.session.problem().dimension, self);
  };
}

/// Returns values per dof from nodes × dimension numbers, or from one vector for all nodes; the other dofs keep those
/// of `others`.
Vector dofs_of(OpenSession& open, const Numbers& numbers, Vector others, const char* what) {
  const SemidiscreteProblem& problem = open.problem();
  const Index nodes = nodes_of(problem), d = problem.dimension;
  if (numbers.ndim() == 1 && numbers.size() == d) {
    for (Index node = 0; node < nodes; ++node) others.segment(node * d, d) = vector_of(numbers);
  } else if (numbers.ndim() == 2 && numbers.shape(0) == nodes && numbers.shape(1) == d) {
    others.head(nodes * d) = vector_of(numbers);
  } else {
    throw Error(ErrorKind::invalid_input,
                fmt::format("session: a {} must be an array of {} nodes x {} numbers, or {} numbers for all nodes",
                            what, nodes, d, d));
  }
  return others;
}

Vector no_force(OpenSession& open) { return Vector::Zero(open.problem().dof_count()); }

py::array_t<double> contact_places(OpenSession& open) {
  const SemidiscreteProblem& problem = open.problem();
  Matrix places = Matrix::Zero(problem.dimension, problem.contact.size());
  for (Index point = 0; point < places.cols(); ++point) {
    double sum = 0.0;
    problem.contact.visit_own_nodes(point, [&](Index node, double weight) {
      places.col(point) += weight * problem.nodes.col(node);
      sum += weight;
    });
    if (sum != 0.0) places.col(point) /= sum;
  }
  const Index rows = places.cols(), columns = places.rows();
  return owned_array(std::move(places), rows, columns);
}

py::array_t<double> contact_force(OpenSession& open) {
  const State& state = open.state();
  const SemidiscreteProblem& problem = open.session.problem();
  Vector force = Vector::Zero(problem.dof_count());
  state.forces.rows->add_force(state.forces.acting_normal(), state.forces.acting_tangential(), force);
  return owned_array(std::move(force), nodes_of(problem), problem.dimension);
}

py::dict energies(OpenSession& open) {
  py::dict result;
  EnergyAccount& account = open.simulation().account();
  for (const auto& [name, value] : balance_of(open.session.state(), account)) result[py::str(name)] = value;
  return result;
}

void write_to(OpenSession& open, const std::string& directory, bool force, bool resume, bool quiet,
              const std::string& export_contact, const std::string& case_path,
              const std::vector<std::string>& settings) {
  RunOptions options;
  options.output_directory = directory;
  options.force = force;
  options.resume = resume;
  options.quiet = quiet;
  options.case_path = case_path;
  options.settings = settings;
  options.stop_signal = [&open] { return open.signals(); };
  if (!export_contact.empty()) options.export_contact = parse_steps(export_contact);
  open.alone([&] { open.session.write_to(std::move(options)); });
  open.writes = true;
}

py::bytes save(OpenSession& open) {
  return py::bytes(open.alone([&] {
    Snapshot snapshot;
    open.session.save(snapshot);
    return encode_snapshot(snapshot);
  }));
}

void resume(OpenSession& open, const py::bytes& saved) {
  const std::string text = saved;
  open.alone([&] { open.session.resume(decode_snapshot(text)); });
}

template <class Class>
void bind_looks(Class& session) {
  session
      .def_property_readonly("displacement", nodal([](const State& s) -> const Vector& { return s.displacement; }),
                             "Displacements of the nodes, nodes x dimension; a view.")
      .def_property_readonly("velocity", nodal([](const State& s) -> const Vector& { return s.velocity; }),
                             "Velocities of the nodes, nodes x dimension; a view.")
      .def_property_readonly("acceleration", nodal([](const State& s) -> const Vector& { return s.acceleration; }),
                             "Accelerations of the nodes, nodes x dimension; a view.")
      .def_property_readonly(
          "reactions",
          [](const py::object& self) {
            const Vector& r = self.cast<OpenSession&>().state().forces.normal_reaction;
            return view(r.data(), r.size(), 0, self);
          },
          "Normal forces of the contact points at the instants of the history (0 if open); a view.")
      .def_property_readonly(
          "friction_reactions",
          [](const py::object& self) {
            auto& open = self.cast<OpenSession&>();
            const Vector& r = open.state().forces.tangential_reaction;
            const Index tangents = open.session.problem().dimension - 1;
            return view(r.data(), r.size() / tangents, tangents, self);
          },
          "Friction forces of the contact points along their tangents; a view.")
      .def_property_readonly(
          "contact_status", [](OpenSession& open) { return numbers_of(open.state().contact_status); },
          "Status of the contact points: 0 open, 1 closed without friction, 2 sticking, 3 slipping.")
      .def_property_readonly(
          "gaps",
          [](OpenSession& open) {
            Vector gaps;
            const State& state = open.state();
            open.session.problem().gaps(state.displacement, state.time, gaps);
            const Index count = gaps.size();
            return owned_array(std::move(gaps), count);
          },
          "Gaps of the contact points, positive if open.")
      .def_property_readonly(
          "contact_force", &contact_force,
          "Force on each node that acted over the last step, nodes x dimension: multiplied by the step, it is\n"
          "the change of the momentum. `reactions` are those at the end of the step.")
      .def_property_readonly("energies", &energies,
                             "Parts of the energy account, with the names of the columns of the history.")
      .def_property_readonly(
          "time", [](OpenSession& open) { return open.state().time; }, "Time of the state.")
      .def_property_readonly(
          "step_number", [](OpenSession& open) { return open.state().step; }, "Number of completed steps.")
      .def_property_readonly(
          "iterations", [](OpenSession& open) { return open.state().iterations; },
          "Iterations of the contact solver in the last step.")
      .def_property_readonly(
          "at_end",
          [](OpenSession& open) {
            (void)open.simulation();
            return open.session.at_end();
          },
          "Whether no step is left.");
}

template <class Class>
void bind_problem(Class& session) {
  session.def_property_readonly("dimension", [](OpenSession& open) { return open.problem().dimension; })
      .def_property_readonly(
          "points",
          [](OpenSession& open) {
            const SemidiscreteProblem& problem = open.problem();
            Points points = problem.nodes.leftCols(nodes_of(problem));
            return owned_array(std::move(points), nodes_of(problem), problem.dimension);
          },
          "Reference positions of the nodes, nodes x dimension.")
      .def_property_readonly(
          "node_numbers",
          [](OpenSession& open) {
            (void)open.problem();
            std::vector<Index> numbers = open.session.model().space.number;
            numbers.resize(std::size_t(nodes_of(open.session.problem())));
            const auto count = Index(numbers.size());
            return owned_array(std::move(numbers), count);
          },
          "Numbers of the nodes in the mesh.")
      .def_property_readonly("contact_points", &contact_places, "Reference positions of the contact points.")
      .def_property_readonly("mass_parts", [](OpenSession& open) { return parts_of(open.problem().mass.to_sparse()); })
      .def_property_readonly("mass_built",
                             [](OpenSession& open) {
                               (void)open.problem();
                               return open.session.model().mass_built;
                             })
      .def("stiffness_parts", [](OpenSession& open, bool at_state) {
        const InternalForce& force = *open.problem().internal_force;
        return parts_of(at_state ? force.tangent(open.state().displacement) : force.tangent());
      });
}

}  // namespace

void bind_session(py::module_& module) {
  py::class_<OpenSession> session(module, "Session");
  session.def(py::init<Case, std::vector<std::string>>(), py::arg("case"), py::arg("remarks"))
      .def("step", &OpenSession::step,
           "Computes one step. Returns False, without any effect, at the end of the run; further calls cause a\n"
           "warning. Raises NotConvergedError; the state is then the one before the step.")
      .def("_run", &OpenSession::run, py::arg("each"), py::arg("progress"))
      .def("_run_steps", &OpenSession::take_steps)
      .def("_write_to", &write_to)
      .def("_finish", &OpenSession::finish)
      .def("_keep",
           [](OpenSession& open) {
             if (open.writes) open.alone([&] { open.session.write_checkpoint_now(); });
           })
      .def("_save", &save)
      .def("_resume", &resume)
      .def_property_readonly("writes", [](const OpenSession& open) { return open.writes; })
      .def_property_readonly("is_complete_already",
                             [](const OpenSession& open) { return open.session.is_complete_already(); })
      .def("build", [](OpenSession& open) { (void)open.problem(); })
      .def(
          "start", [](OpenSession& open) { (void)open.simulation(); },
          "Computes the state at t = 0 and factorizes, unless this is already done.")
      .def(
          "set_load",
          [](OpenSession& open, const Numbers& force) {
            const Vector dofs = dofs_of(open, force, no_force(open), "load");
            open.alone([&] { open.session.set_load(dofs); });
          },
          py::arg("force"))
      .def(
          "set_velocity",
          [](OpenSession& open, const Numbers& velocity) {
            const Vector dofs = dofs_of(open, velocity, open.state().velocity, "velocity");
            open.alone([&] { open.session.set_velocity(dofs); });
          },
          py::arg("velocity"))
      .def(
          "set_obstacle_velocity",
          [](OpenSession& open, const std::string& obstacle, const Numbers& velocity,
             const std::optional<Numbers>& rotation_rate) {
            const Vector v = vector_of(velocity), w = rotation_rate ? vector_of(*rotation_rate) : Vector();
            open.has_problem = false;  // the first call builds it anew
            open.alone([&] { open.session.set_obstacle_velocity(obstacle, v, w); });
          },
          py::arg("obstacle"), py::arg("velocity"), py::arg("rotation_rate") = py::none(),
          "Moves an obstacle from its present position, with a constant velocity and, if the case defines a rotation\n"
          "for it, a constant rate of its rotation vector. The first call must precede the start of the session.")
      .def_property_readonly(
          "warnings", [](const OpenSession& open) { return open.session.warnings(); }, "Warnings so far.")
      .def_property_readonly(
          "steps", [](const OpenSession& open) { return open.session.steps(); },
          "Number of steps from the start to the end.")
      .def_property_readonly("end", [](OpenSession& open) {
        const double end = open.session.end();
        // The last step ends at or after the end, except for rounding: a loop until the end must terminate.
        if (open.session.is_complete_already()) return end;
        (void)open.simulation();
        return open.session.at_end() ? std::min(end, open.session.time()) : end;
      });
  bind_looks(session);
  bind_problem(session);
}

}  // namespace ricochet::python
