#include <fmt/format.h>

#include <algorithm>

#include "advice_text.hpp"
#include "commands.hpp"
#include "place_text.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/mesh/read_mesh.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/session.hpp"
#include "ricochet/simulation/simulation.hpp"
#include "ricochet/solver/step_estimate.hpp"

namespace ricochet::program {

namespace {

/// A start whose factorizations take longer than this, in seconds by estimate, is left to the run: they take the memory
/// that a user wants to know before.
constexpr double longest_start = 3.0;

std::string short_duration_text(double seconds) {
  return seconds < 1.0 ? fmt::format("{:.2g} s", seconds) : duration_text(seconds);
}

/// "0.2 s for 100 steps"; of adaptive steps the number is not known before the run.
std::string steps_estimate(const TimeSection& time, double step_seconds) {
  const long steps = step_count(time);
  return fmt::format("{}{} for {}{}", time.adaptive ? "at least " : "",
                     short_duration_text(static_cast<double>(steps) * step_seconds), counted(steps, "step"),
                     time.adaptive ? " of the longest" : "");
}

void print_estimate(const StageEstimate& stage, std::size_t number, const TimeSection& time) {
  const std::string of =
      fmt::format("estimate, stage {} of a step, {}", number + 1, counted(stage.unknowns, "unknown"));
  if (stage.chosen.method == SolverMethod::iterative) {
    fmt::print(
        "{}: method iterative, some {:.0f} iterations; {} per step, {}; its memory is a few times that of the "
        "matrices; chosen as {}{}\n",
        of, stage.iterations, short_duration_text(stage.step_seconds), steps_estimate(time, stage.step_seconds),
        stage.chosen.reason,
        stage.chosen.predicted_entries > 0.0
            ? fmt::format(" (a factor would have {:.3g} entries and take {:.2g} operations)",
                          stage.chosen.predicted_entries, stage.chosen.predicted_operations)
            : "");
    return;
  }
  fmt::print(
      "{}: method direct; a factor of {:.3g} entries, {:.2g} GB, {:.2g} GB while it is made, in {}; {} per step, "
      "{}; {:.2g} GB for every 100 contact points that may touch at a time; chosen as {}\n",
      of, stage.chosen.predicted_entries, 1e-9 * stage.factor_bytes, 1e-9 * stage.peak_bytes,
      short_duration_text(stage.factorization_seconds), short_duration_text(stage.step_seconds),
      steps_estimate(time, stage.step_seconds), 100e-9 * stage.bytes_per_point, stage.chosen.reason);
}

/// What a run will take, and seconds until its first step.
double estimate(const Case& input, const SemidiscreteProblem& problem, const Scheme& scheme) {
  const std::vector<StageEstimate> stages =
      estimate_step_solver(problem, scheme.operators(problem), step_solver_options(input));
  const double products = estimate_products(problem);
  double seconds = 0.0, per_step = products;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    print_estimate(stages[k], k, input.time);
    seconds += stages[k].factorization_seconds;
    per_step += stages[k].step_seconds;
  }
  const double steps = static_cast<double>(step_count(input.time));
  fmt::print("estimate, all: {} for factorizations{}, {} per step with {} for the products with the matrices, {}{}\n",
             short_duration_text(seconds), input.time.adaptive ? " for each length of a step" : "",
             short_duration_text(per_step), short_duration_text(products), input.time.adaptive ? "at least " : "",
             short_duration_text(seconds + steps * per_step));
  fmt::print(
      "(estimates: entries and operations from the symbolic analysis of the operators; times at {:.2g} operations "
      "and {:.2g} bytes per second of one core, without assembly, ordering, output and the contact problems{})\n",
      estimated_operations_per_second, estimated_bytes_per_second,
      problem.internal_force->is_linear()
          ? ""
          : "; of one iteration of Newton's method a step: 5 to 30 are usual, hundreds where rubber is pressed hard");
  return seconds;
}

/// Whether there is a mesh of it to be checked, or one may be made: gmsh may run shell commands of the file, and
/// meshing may take long.
bool has_mesh(const MeshFile& file) {
  if (!needs_gmsh_program(file.path)) return true;
  try {
    return is_meshed(file);
  } catch (const Error& problem) {
    if (problem.kind() != ErrorKind::invalid_input) throw;
    log::warning(problem.what());  // the gmsh program is not there
    return false;
  }
}

std::vector<std::string> files_without_mesh(const Case& input, const ValidateArguments& arguments) {
  std::vector<std::string> paths;
  if (arguments.mesh) return paths;
  require_mesh_files(input);
  for (const CaseMeshFile& file : mesh_files(input)) {
    if (!has_mesh(file.file)) paths.push_back(file.file.path);
  }
  return paths;
}

void print_valid_without(const std::vector<std::string>& files, const ValidateArguments& arguments) {
  const std::string& case_file = arguments.case_file;
  fmt::print("{}: valid, as far as can be told without a mesh of {}\n", case_file, join_names(files, " and ", false));
  fmt::print(
      "{}: not checked: what needs the mesh: names of groups, numbers of components, materials, supports, contacts, "
      "probes, columns of [[expect]], memory and time, and the start of the run; `ricochet validate {}{} --mesh` "
      "meshes the {} and checks them{}\n",
      case_file, case_file, arguments.overrides.empty() ? "" : " --set …", files.size() == 1 ? "file" : "files",
      std::any_of(files.begin(), files.end(), may_run_commands)
          ? " (gmsh runs shell commands that a .geo or .opt file contains: mesh files that you trust)"
          : "");
}

}  // namespace

int validate(const ValidateArguments& arguments) {
  const std::string& case_file = arguments.case_file;
  Session session(case_file, arguments.overrides);
  const Case& input = session.input();
  warn_of_end(input.time);
  if (const std::vector<std::string> files = files_without_mesh(input, arguments); !files.empty()) {
    print_valid_without(files, arguments);
    return 0;
  }
  const Model& model = session.model();
  check_expected_quantities(input, model);
  refuse_bodies_inside_obstacles(input, model);
  session.scheme().analyse(model.problem);
  const double start_seconds = estimate(input, model.problem, session.scheme());
  // The start of a run, thrown away: some things do not go together, and some operators cannot be factorized.
  const bool starts = start_seconds <= longest_start;
  if (starts) session.start();
  fmt::print("{}: valid: {}, {}, {}, {}, {}\n", case_file, counted(model.space.cell_node_count(), "node"),
             counted(model.mesh.cell_count(), "cell"), counted(model.problem.contact.size(), "contact point"),
             counted(model.problem.supports.size(), "supported dof"),
             input.time.adaptive ? steps_text(input.time) : counted(step_count(input.time), "step"));
  print_place(input, model);
  print_facings(input, model);
  if (!starts) {
    fmt::print(
        "{}: not checked: the start of the run (whether its operators can be factorized, and its initial state), "
        "which would take {} by estimate\n",
        case_file, duration_text(start_seconds));
  }
  return 0;
}

}  // namespace ricochet::program
