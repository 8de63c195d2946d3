#include "ricochet/case/run_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/run_name.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/run.hpp"

namespace ricochet {

namespace {

/// Fails early: a run of hours should not end because its last step cannot be written.
void check_export(const Case& input, const RunOptions& options, long steps) {
  if (options.export_contact.empty()) return;
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    if (!(input.contacts[i].friction_bound > 0.0)) continue;
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: contact problems with a friction_bound cannot be exported: FCLib's files state "
                            "Coulomb's law only",
                            input.where(fmt::format("contact.{}.friction_bound", i)).text()));
  }
  const auto& asked = options.export_contact;
  const bool some = std::any_of(asked.begin(), asked.end(), [&](const StepRange& r) { return r.first <= steps; });
  const bool all = std::all_of(asked.begin(), asked.end(), [&](const StepRange& r) { return r.last <= steps; });
  if (!some)
    throw Error(ErrorKind::usage, fmt::format("--export-contact: the run has {} only", counted(steps, "step")));
  if (!all)
    log::warning(fmt::format("--export-contact: the run has {}; those after it are left out", counted(steps, "step")));
}

}  // namespace

StepSolverOptions step_solver_options(const Case& input) {
  StepSolverOptions options;
  if (input.solver.method == "direct") options.method = SolverMethod::direct;
  if (input.solver.method == "iterative") options.method = SolverMethod::iterative;
  options.tolerance = input.solver.tolerance;
  options.memory = 1e9 * input.solver.memory.value_or(0.0);
  options.all_points = input.solver.contact_points == "all";
  return options;
}

long step_count(const TimeSection& time) {
  // An end that is a whole number of steps to rounding is that number of steps.
  return std::max(1L, static_cast<long>(std::ceil(time.end / time.step * (1.0 - 1e-12))));
}

void warn_of_end(const TimeSection& time) {
  const double end = static_cast<double>(step_count(time)) * time.step;
  if (std::abs(end - time.end) <= 1e-9 * time.end) return;
  log::warning(
      fmt::format("{}{:.9g} is no whole number of steps of {:.9g}: the run ends at t = {:.9g}, after "
                  "step {}",
                  end_warning, time.end, time.step, end, step_count(time)));
}

RunSummary run_case(const Case& input, const RunOptions& options) {
  log::clear_warnings();
  // Of runs that are silent but for their warnings there may be many at once.
  log::set_run_name(options.quiet ? options.output_directory : "");
  check_export(input, options, step_count(input.time));
  return Run(input, options).go();
}

}  // namespace ricochet
