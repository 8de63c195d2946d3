#include <fmt/format.h>

#include "commands.hpp"
#include "ricochet/case/model.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/case/run_case.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/mesh/read_mesh.hpp"
#include "ricochet/simulation/simulation.hpp"
#include "ricochet/solver/step_estimate.hpp"

namespace ricochet::program {

namespace {

/// A start that takes longer than this, in seconds by estimate, is left to the run.
constexpr double longest_start = 30.0;

std::string short_duration_text(double seconds) {
  return seconds < 1.0 ? fmt::format("{:.2g} s", seconds) : duration_text(seconds);
}

void print_estimate(const StageEstimate& stage, std::size_t number, long steps) {
  const std::string of = fmt::format("estimate, stage {} of a step, {} unknowns", number + 1, stage.unknowns);
  if (stage.chosen.method == SolverMethod::iterative) {
    fmt::print(
        "{}: method iterative{}; its memory is a few times that of the matrices, its time per step is not "
        "estimated\n",
        of,
        stage.chosen.predicted_entries > 0.0
            ? fmt::format(" (a factor would have {:.3g} entries and take {:.2g} operations)",
                          stage.chosen.predicted_entries, stage.chosen.predicted_operations)
            : "");
    return;
  }
  fmt::print(
      "{}: method direct; a factor of {:.3g} entries, {:.2g} GB, {:.2g} GB while it is made, in {}; {} per step, "
      "{} for {} steps; {:.2g} GB for every 100 contact points that may touch at a time\n",
      of, stage.chosen.predicted_entries, 1e-9 * stage.factor_bytes, 1e-9 * stage.peak_bytes,
      short_duration_text(stage.factorization_seconds), short_duration_text(stage.step_seconds),
      short_duration_text(static_cast<double>(steps) * stage.step_seconds), steps, 100e-9 * stage.bytes_per_point);
}

/// What a run will take, and seconds until its first step.
double estimate(const Case& input, const SemidiscreteProblem& problem, const Scheme& scheme) {
  const std::vector<StageEstimate> stages =
      estimate_step_solver(problem, scheme.operators(problem), step_solver_options(input));
  double seconds = 0.0;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    print_estimate(stages[k], k, step_count(input.time));
    seconds += stages[k].factorization_seconds;
  }
  fmt::print(
      "(estimates: entries and operations from the symbolic analysis of the operators; times at {:.2g} operations "
      "and {:.2g} bytes per second of one core, without output and the contact problems)\n",
      estimated_operations_per_second, estimated_bytes_per_second);
  return seconds;
}

}  // namespace

int validate(const std::string& case_file, const std::vector<std::string>& overrides) {
  const Case input = read_case(case_file, overrides);
  warn_of_end(input.time);
  if (needs_gmsh_program(input.mesh.file)) {
    require_mesh_file(input);
    // A .geo file can run shell commands: only `run` hands one to gmsh.
    fmt::print("{}: valid, as far as can be told without meshing {}\n", case_file, input.mesh.file);
    return 0;
  }
  const std::unique_ptr<Model> model = build_model(input);
  check_expected_columns(input, *model);
  const std::unique_ptr<Scheme> scheme = make_scheme(input.time);
  scheme->analyse(model->problem);
  const double start_seconds = estimate(input, model->problem, *scheme);
  // The start of a run, thrown away: some things do not go together, and some operators cannot be factorized.
  const bool starts = start_seconds <= longest_start;
  if (starts) (void)Simulation(model->problem, *scheme, model->initial, step_solver_options(input));
  fmt::print("{}: valid: {} nodes, {} cells, {} contact points, {} supported dofs, {} steps\n", case_file,
             model->space.node_count(), model->mesh.cell_count(), model->problem.contact.size(),
             model->problem.supports.size(), step_count(input.time));
  if (!starts) {
    fmt::print(
        "{}: not checked: the start of the run (whether its operators can be factorized, and its initial state), "
        "which would take {} by estimate\n",
        case_file, duration_text(start_seconds));
  }
  return 0;
}

}  // namespace ricochet::program
