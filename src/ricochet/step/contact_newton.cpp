#include "ricochet/step/contact_newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/log.hpp"

namespace ricochet {

void ContactNewton::restart(NewtonEquations& equations) {
  progress_.restart();
  equations.forget_iterates();
}

bool ContactNewton::freeze(NewtonEquations& equations) {
  if (!equations.freeze()) return false;
  restart(equations);
  return true;
}

bool ContactNewton::evaluate_with_halving(NewtonEquations& equations) {
  for (int halving = 0;; ++halving) {
    try {
      equations.evaluate();
      return halving > 0;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged || halving == max_halvings) throw;
    }
    equations.halve();
  }
}

/// Throws Error(not_converged) where many iterations are left.
void ContactNewton::give_up_early(const NewtonEquations::Iteration& iteration) const {
  const int done = progress_.iterations();
  const bool is_slow = done >= thresholds_.early_iterations &&
                       progress_.expected_iterations(iteration.increment) > thresholds_.early_iterations;
  const bool diverges = iteration.correction > thresholds_.early_divergence * progress_.least_correction();
  if (is_slow || diverges || done >= thresholds_.max_early_iterations) throw progress_.failure(iteration.correction);
}

void ContactNewton::follow(NewtonProgress::Advice advice, NewtonEquations& equations,
                           const NewtonEquations::Iteration& iteration, Persistence persistence) {
  using Advice = NewtonProgress::Advice;
  if (persistence == Persistence::brief) give_up_early(iteration);
  // Pairs may change from iteration to iteration.
  const bool is_stuck =
      advice == Advice::failed || (advice == Advice::renew && progress_.iterations() > thresholds_.max_pair_iterations);
  if (is_stuck && persistence == Persistence::full && freeze(equations)) return;
  if (advice == Advice::failed) throw progress_.failure(iteration.correction);
  if (advice != Advice::renew) return;
  equations.renew();
  progress_.count_renewal();
  restart(equations);
}

void ContactNewton::solve(NewtonEquations& equations, const NewtonScale& scale, Persistence persistence) {
  using Advice = NewtonProgress::Advice;
  progress_.start(scale.rounding, scale.renewal_price, scale.tolerance);
  equations.forget_iterates();
  while (true) {
    const NewtonEquations::Iteration iteration = equations.iterate();
    const Advice advice = progress_.assess(iteration.correction, iteration.increment);
    if (advice == Advice::done && !equations.has_conditions_on_solution()) return;
    if (advice == Advice::proceed && progress_.wants_acceleration()) equations.accelerate();
    // Reactions of an increment that was halved are not its own: contact conditions hold for the whole one.
    const bool is_done = !evaluate_with_halving(equations) && advice == Advice::done;
    const bool is_near = iteration.correction <= thresholds_.near_solution * iteration.increment;
    if ((is_done || is_near) && equations.refine(is_done)) {
      equations.evaluate();
      restart(equations);
      continue;
    }
    if (!is_done) {
      follow(advice, equations, iteration, persistence);
      continue;
    }
    try {
      if (equations.accept(iteration, !progress_.is_tight())) return;
      progress_.tighten();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged || persistence == Persistence::brief || !freeze(equations)) throw;
    }
  }
}

void ContactNewton::descend(NewtonEquations& equations, const ProximalThresholds& thresholds) {
  double weight = thresholds.first, last = 0.0;
  int failures = 0;  // in a row
  for (int iteration = 0; weight > 0.0; ++iteration) {
    if (iteration == thresholds.max_iterations)
      throw Error(ErrorKind::not_converged, fmt::format("no descent to a solution in {} iterations", iteration));
    equations.set_proximal_weight(weight);
    double correction = std::numeric_limits<double>::infinity();
    try {
      correction = equations.iterate().correction;
      if (evaluate_with_halving(equations)) correction = std::numeric_limits<double>::infinity();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      if (++failures == thresholds.max_failures) throw;
      equations.take_back();
    }
    if (log::enabled(log::Level::debug))
      log::debug(fmt::format("descent: iteration {}, weight {:.2e}, correction {:.2e}", iteration, weight, correction));
    if (!std::isfinite(correction)) {
      weight = std::max(thresholds.retry * weight, thresholds.least_after_failure);
      continue;
    }
    failures = 0;
    const double motion = correction * (1.0 + weight);  // that of the weight zero, roughly
    if (last > 0.0) weight *= std::clamp(motion / last, thresholds.largest_decrease, thresholds.growth);
    last = motion;
    if (weight < thresholds.least) weight = 0.0;
  }
  equations.set_proximal_weight(0.0);
}

}  // namespace ricochet
