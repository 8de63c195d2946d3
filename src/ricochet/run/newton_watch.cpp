#include "ricochet/run/newton_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/rounded.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/simulation/simulation.hpp"

namespace ricochet {

namespace {

constexpr const char *scheme = "semi-explicit", *mass = "equivalent-lumped";
/// Ratio of the step to the critical step of the undeformed body.
constexpr double safe_part = 0.7;

double first_steps(const Case& input, const Model& model) {
  constexpr int steps = 20;
  const std::unique_ptr<Scheme> stepper = make_scheme(input.time);
  Simulation simulation(model.problem, *stepper, model.initial, step_solver_options(input));
  const Timer timer;
  for (int k = 0; k < steps; ++k) simulation.advance();
  return timer.seconds() / steps;
}

}  // namespace

bool NewtonWatch::enter_step(int iterations, double seconds) {
  constexpr double several = 3.0, forgotten = 0.1;
  if (iterations <= many) {
    weight_ = std::max(0.0, weight_ - forgotten);
    return false;
  }
  weight_ += 1.0;
  ++steps_;
  seconds_ += seconds;
  if (has_warned_ || weight_ < several) return false;
  has_warned_ = true;
  return true;
}

void NewtonWatch::persist(const SnapshotVisitor& visit) {
  constexpr double limit = 1e15;  // integers below it are exact
  const Vector numbers = visit.numbers("", weight_, steps_, seconds_, has_warned_);
  visit.require((numbers.array() >= 0.0 && numbers.array() < limit).all(), "",
                fmt::format("has entries that are not between 0 and {:g}", limit));
}

ExplicitRun try_explicit(const Case& input) {
  const log::Silence silence;
  std::vector<std::string> unsaid;
  const log::CollectWarnings collect(unsaid);
  ExplicitRun result;
  Case other = input;
  other.time.scheme = scheme;
  other.time.parameters = {};
  other.time.adaptive = false;
  other.mass.type = mass;
  other.mass.parameters = {};
  try {
    const std::unique_ptr<Model> model = build_model(other);
    const std::optional<double> limit = make_scheme(other.time)->stability_limit(model->problem);
    if (!limit || !std::isfinite(*limit)) {
      result.refusal = "its critical step is unknown";
      return result;
    }
    result.critical_step = *limit;
    other.time.step = result.step = rounded_down(safe_part * *limit, 2);
    result.seconds_per_step = first_steps(other, *model);
  } catch (const Error& problem) {
    result.refusal = problem.what();
  }
  return result;
}

std::string many_iterations_text(const NewtonWatch& watch, const ExplicitRun& other, double now, double left,
                                 double step) {
  const std::string what = fmt::format(
      "at t = {:.6g} Newton's method has needed more than {} iterations in each of {} steps, {:.2g} s per step", now,
      NewtonWatch::many, watch.steps(), watch.seconds_per_step());
  if (!other.refusal.empty()) {
    return fmt::format(
        "{}; scheme \"{}\" with mass.type = \"{}\", which solves no system of the whole body, does not support this "
        "case: {}",
        what, scheme, mass, other.refusal);
  }
  const double own = left / step * watch.seconds_per_step(), steps = std::ceil((now + left) / other.step);
  return fmt::format(
      "{}, which amounts to {} for the rest of the run. Scheme \"{}\" with mass.type = \"{}\" solves no system of the "
      "whole body and supports this case with time.step = {:.2g}, {:g} times its critical step at rest: {:.2g} steps "
      "from the start, {} at the rate of the first ones. With it, a slow load can be applied faster, as long as the "
      "kinetic energy stays small compared with the elastic energy",
      what, duration_text(own), scheme, mass, other.step, safe_part, steps,
      duration_text(steps * other.seconds_per_step));
}

}  // namespace ricochet
