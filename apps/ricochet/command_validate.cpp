#include <fmt/format.h>

#include <algorithm>

#include "commands.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/mesh/read_mesh.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/cost_estimate.hpp"
#include "ricochet/run/field_schedule.hpp"
#include "ricochet/run/session.hpp"
#include "ricochet/simulation/simulation.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

/// Estimated seconds of factorizations above which the start is left to the run: they need the memory that a user wants
/// to know in advance.
constexpr double longest_start = 3.0;

std::string short_duration_text(double seconds) {
  return seconds < 1.0 ? fmt::format("{:.2g} s", seconds) : duration_text(seconds);
}

void print_estimate(const StageEstimate& stage, std::size_t number) {
  const std::string of =
      fmt::format("estimate, stage {} of a step, {}", number + 1, counted(stage.unknowns, "unknown"));
  if (stage.chosen.method == SolverMethod::iterative) {
    fmt::print("{}: method iterative, about {:.0f} iterations, {}; reason: {}{}\n", of, stage.iterations,
               short_duration_text(stage.step_seconds), stage.chosen.reason,
               stage.chosen.predicted_entries > 0.0
                   ? fmt::format(" (a factor would have {:.3g} entries and require {:.2g} operations)",
                                 stage.chosen.predicted_entries, stage.chosen.predicted_operations)
                   : "");
    return;
  }
  fmt::print(
      "{}: method direct; a factor of {:.3g} entries, {:.2g} GB, {:.2g} GB during the factorization, which takes {}; "
      "{} per solve; {:.2g} GB per 100 contact points that may touch at the same time; reason: {}\n",
      of, stage.chosen.predicted_entries, 1e-9 * stage.factor_bytes, 1e-9 * stage.peak_bytes,
      short_duration_text(stage.factorization_seconds), short_duration_text(stage.step_seconds),
      100e-9 * stage.bytes_per_point, stage.chosen.reason);
}

/// Returns a text such as "0.2 s without contact, 12 s with a quarter of the 40 contact points closed, 2 min 30 s with
/// all closed".
template <class Text>
std::string range_text(const CostRange& range, Index points, const Text& text) {
  if (points == 0) return text(range.most);
  return fmt::format("{} without contact, {} with a quarter of the {} closed, {} with all closed", text(range.least),
                     text(range.some), counted(points, "contact point"), text(range.most));
}

std::string iterations_note(const CostEstimate& cost) {
  if (cost.force_seconds > 0.0)
    return fmt::format(" ({} to {} iterations of Newton's method; hundreds where rubber is strongly compressed)",
                       cost.least_iterations, cost.most_iterations);
  if (cost.most_iterations > 1)
    return fmt::format(" ({} to {} iterations, because normals rotate)", cost.least_iterations, cost.most_iterations);
  return "";
}

void print_estimates(const Case& input, const Model& model, const CostEstimate& cost) {
  for (std::size_t k = 0; k < cost.stages.size(); ++k) print_estimate(cost.stages[k], k);
  const auto steps = double(step_count(input.time));
  const Index points = model.problem.contact.size();
  const auto of_run = [&](double step) { return cost.factorization_seconds + steps * step; };
  fmt::print("estimate, a step{}: {}\n", iterations_note(cost),
             range_text(cost.step_seconds, points, short_duration_text));
  fmt::print("estimate, whole run: {} for factorizations{}; the run takes {}{}{}\n",
             short_duration_text(cost.factorization_seconds), input.time.adaptive ? " for each step length" : "",
             input.time.adaptive ? "at least " : "", short_duration_text(of_run(cost.step_seconds.least)),
             points == 0 ? ""
                         : fmt::format(" to {}, with at most a quarter of the contact points closed at the same time",
                                       short_duration_text(of_run(cost.step_seconds.some))));
  fmt::print("estimate, memory: {}\n", range_text(cost.memory, points, size_text));
  fmt::print("estimate, files: {}\n", output_text(estimate_output(input, model)));
  fmt::print(
      "(estimates: entries and operations from the symbolic analysis of the operators; times at {:.2g} operations and "
      "{:.2g} bytes per second of one core{}, without assembly, ordering and output; after some seconds of steps, "
      "`run` reports the remaining time at their pace)\n",
      estimated_operations_per_second, estimated_bytes_per_second,
      cost.force_seconds > 0.0 ? fmt::format(", with {} per evaluation of the internal force, measured here",
                                             short_duration_text(cost.force_seconds))
                               : "");
}

/// Returns true if there is a mesh to check, or one may be made: gmsh may run shell commands of the file, and meshing
/// may take long.
bool has_mesh(const MeshFile& file) {
  if (!needs_gmsh_program(file.path)) return true;
  try {
    return is_mesh_cached(file);
  } catch (const Error& problem) {
    if (problem.kind() != ErrorKind::invalid_input) throw;
    log::warning(problem.what());  // the gmsh program is not installed
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
  fmt::print("{}: valid, as far as can be checked without a mesh of {}\n", case_file,
             join_names(files, " and ", false));
  fmt::print(
      "{}: not checked, because it requires the mesh: names of groups, numbers of components, materials, supports, "
      "contacts, probes, columns of [[expect]], memory and time, and the start of the run; `ricochet validate {}{} "
      "--mesh` meshes the {} and checks them{}\n",
      case_file, case_file, arguments.overrides.empty() ? "" : " --set …", files.size() == 1 ? "file" : "files",
      std::ranges::any_of(files, may_run_commands)
          ? " (gmsh runs shell commands that a .geo or .opt file contains: mesh only files that you trust)"
          : "");
}

}  // namespace

int validate(const ValidateArguments& arguments) {
  const std::string& case_file = arguments.case_file;
  Session session(case_file, arguments.overrides);
  const Case& input = session.input();
  warn_of_end(input.time);
  if (const std::vector<std::string> files = files_without_mesh(input, arguments); !files.empty()) {
    check_without_mesh(input);
    print_valid_without(files, arguments);
    return 0;
  }
  const Model& model = session.model();
  check_expected_quantities(input, model);
  refuse_bodies_inside_obstacles(input, model);
  session.scheme().analyse(model.problem);
  const CostEstimate cost = estimate_cost(input, model, session.scheme());
  // The start of a run, whose result is discarded: it detects incompatible settings and operators that cannot be
  // factorized.
  const bool starts = cost.factorization_seconds <= longest_start;
  if (starts) session.start();
  fmt::print("{}: valid: {}, {}, {}, {}, {}\n", case_file, counted(model.space.cell_node_count(), "node"),
             counted(model.mesh.cell_count(), "cell"), counted(model.problem.contact.size(), "contact point"),
             counted(model.problem.supports.size(), "supported dof"),
             input.time.adaptive ? steps_text(input.time) : counted(step_count(input.time), "step"));
  print_position(input, model);
  print_facings(input, model);
  if (!starts) {
    fmt::print(
        "{}: not checked: the start of the run (whether its operators can be factorized, and its initial state), which "
        "would take an estimated {}\n",
        case_file, duration_text(cost.factorization_seconds));
  }
  print_estimates(input, model, cost);
  return 0;
}

}  // namespace ricochet::program
