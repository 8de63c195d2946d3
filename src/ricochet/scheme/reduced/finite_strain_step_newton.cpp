#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/scheme/reduced/finite_strain_step.hpp"
#include "ricochet/scheme/reduced/massless_contact_step.hpp"
#include "ricochet/step/factor_debt.hpp"

/// @file Newton's method with the exact tangent of a step.
namespace ricochet {

namespace {

/// Keys of State::memory: two waits (Wait), that of the kept factor and that of the exact tangent; and a FactorDebt.
constexpr const char* newton_waits = "newton_waits";
constexpr const char* factor_debt = "factor_debt";

Vector& numbers_of(State& state, const char* key) {
  Vector& numbers = state.memory[key];
  if (numbers.size() == 0) numbers.setZero(State::memory_numbers);
  return numbers;
}

}  // namespace

/// Attempts for which a way to solve a step is not tried after it failed: more, the more often it has failed.
class FiniteStrainStep::Wait {
 public:
  Wait(State& state, Index number) : memory_(numbers_of(state, newton_waits)), first_(2 * number) {}
  /// Counts an attempt; returns whether the way is to be left out.
  [[nodiscard]] bool goes_on() {
    if (!(memory_[first_] > 0.0)) return false;
    memory_[first_] -= 1.0;
    return true;
  }
  void record(bool has_failed) {
    memory_[first_ + 1] = has_failed ? std::min(2.0 * memory_[first_ + 1] + 1.0, most) : 0.0;
    memory_[first_] = memory_[first_ + 1];
  }

 private:
  static constexpr double most = 31.0;
  Vector& memory_;
  Index first_;
};

/// Solves the linear equations about the present iterate, and moves to their solution. Returns the size of that motion.
FiniteStrainStep::Iteration FiniteStrainStep::iterate_exactly(const SemidiscreteProblem& problem, double step,
                                                              const State& state, StageSolve& stages,
                                                              double proximal_weight) {
  const std::size_t number = MasslessContactStep::midpoint_stage(problem);
  Stage& stage = stages.stage(number);
  last_middle_ = middle_;
  last_end_ = end_;
  balance_middle(problem, step, state, stage);
  if (problem.has_contact_dofs()) {
    linearization_motion_.setZero(end_.size());
    contact_.require(problem, ActingReaction::end, step, state, end_, equations_, stage, &linearization_motion_);
    contact_residual_ = loads_.mean() - end_force_;
    if (loads_.acts_at_ends()) contact_residual_ += loads_.beside_at_end();
  } else {
    stage.conditions.eligible.clear();
    stage.motion.reset();
  }
  const StepIterate at{problem,
                       contact_cells_.get(),
                       step,
                       state,
                       path_rules_,
                       middle_,
                       end_,
                       path_increment_,
                       stage.right_hand_side.force,
                       contact_residual_,
                       stage};
  exact_.assemble(at, exact_solution_, proximal_weight, exact_tangent_);
  stages.solve_exactly(number, exact_tangent_, exact_solution_, unknowns_);
  exact_.write_increments(unknowns_, motion_, next_end_);
  Iteration iteration{std::max(largest_motion(problem, next_end_), 2.0 * largest_motion(problem, motion_)), 0.0};
  middle_ += motion_;
  end_ += next_end_;
  motion_ = 2.0 * (middle_ - base_);
  iteration.increment = largest_motion(problem, motion_);
  return iteration;
}

/// Approaches the solution until Newton's method can take over. An iteration that inverts a cell is halved, and taken
/// back if that does not help; so is one that has no solution. Throws Error(not_converged).
void FiniteStrainStep::descend(const SemidiscreteProblem& problem, double step, const State& state,
                               StageSolve& stages) {
  const ProximalThresholds& limits = thresholds_.proximal;
  double weight = limits.first, last = 0.0;
  for (int iteration = 0; weight > 0.0; ++iteration) {
    if (iteration == limits.max_iterations)
      throw Error(ErrorKind::not_converged, fmt::format("no descent to a solution in {} iterations", iteration));
    const StageSolution before = exact_solution_;
    double correction = std::numeric_limits<double>::infinity();
    try {
      correction = iterate_exactly(problem, step, state, stages, weight).correction;
      if (evaluate_with_halving(problem, step, state)) correction = std::numeric_limits<double>::infinity();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      middle_ = last_middle_;
      end_ = last_end_;
      exact_solution_ = before;
      evaluate(problem, step, state);
    }
    if (log::enabled(log::Level::debug))
      log::debug(fmt::format("descent: iteration {}, weight {:.2e}, correction {:.2e}", iteration, weight, correction));
    if (!std::isfinite(correction)) {
      weight = std::max(limits.retry * weight, limits.least_after_failure);
      continue;
    }
    const double motion = correction * (1.0 + weight);  // that of the weight zero, roughly
    if (last > 0.0) weight *= std::clamp(motion / last, limits.largest_decrease, limits.growth);
    last = motion;
    if (weight < limits.least) weight = 0.0;
  }
}

/// Takes a step by Newton's method with the exact tangent. Throws Error(not_converged).
void FiniteStrainStep::solve_exactly(const SemidiscreteProblem& problem, double step, State& state, StageSolve& stages,
                                     NewtonStart from, Vector& increment) {
  start(problem, step, state);
  if (from != NewtonStart::flight) end_ = middle_ = state.displacement;
  evaluate_prediction(problem, step, state);
  exact_solution_ = {};
  exact_solution_.normal_reaction = state.forces.normal_reaction;
  exact_solution_.tangential_reaction = state.forces.tangential_reaction;
  log::debug(from == NewtonStart::flight ? "exact tangent: begins with the flight"
                                         : "exact tangent: begins with the start of the step");
  if (from == NewtonStart::descent) descend(problem, step, state, stages);
  exact_progress_.start(rounding_of_positions(problem), std::numeric_limits<double>::infinity(),
                        stages.newton_tolerance());
  Stage& stage = stages.stage(MasslessContactStep::midpoint_stage(problem));
  while (true) {
    const Iteration iteration = iterate_exactly(problem, step, state, stages);
    const NewtonProgress::Advice advice = exact_progress_.assess(iteration.correction, iteration.increment);
    const bool is_done = !evaluate_with_halving(problem, step, state) && advice == NewtonProgress::Advice::done;
    const bool is_near = iteration.correction <= thresholds_.near_solution * iteration.increment;
    if ((is_done || is_near) && raise_rules(problem, is_done)) {
      evaluate(problem, step, state);
      exact_progress_.restart();
      continue;
    }
    if (advice == NewtonProgress::Advice::failed) throw exact_progress_.failure(iteration.correction);
    if (!is_done) continue;
    if (close_balance(problem, step, state, stage, exact_solution_, iteration.correction, exact_progress_)) break;
  }
  finish(problem, step, state, stage, exact_solution_, increment);
}

/// Takes a step from the flight and, if that fails, from its start. Returns false if nothing converges.
bool FiniteStrainStep::advance_exactly(const SemidiscreteProblem& problem, double step, State& state,
                                       StageSolve& stages, Vector& increment) {
  for (const NewtonStart from : {NewtonStart::flight, NewtonStart::start_of_step, NewtonStart::descent}) {
    try {
      solve_exactly(problem, step, state, stages, from, increment);
      return true;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      if (log::enabled(log::Level::debug)) log::debug(std::string("exact tangent: ") + error.what());
    }
  }
  return false;
}

/// Takes a step by iterations with a factor that is kept, and renewed where it has become too old.
void FiniteStrainStep::advance_with_debt(const SemidiscreteProblem& problem, ActingReaction acting, double step,
                                         State& state, StageSolve& stages, FailureMode mode, Vector& increment) {
  FactorDebt debt(numbers_of(state, factor_debt));
  if (debt.is_due(stages.renewal_price())) {
    stages.renew_operators(state.displacement, state.displacement);
    debt.clear();
  }
  advance_with_kept_factor(problem, acting, step, state, stages, mode, increment);
  if (progress_.renewals() > 0) debt.clear();
  if ((state.forces.normal_reaction.array() > 0.0).any()) debt.add_step(progress_.iterations());
}

/// Tries iterations with a kept factor and the exact tangent, in this order or, where the former have just failed, in
/// the other one; finally the former without a limit, and with frozen pairs.
void FiniteStrainStep::advance(const SemidiscreteProblem& problem, ActingReaction acting, double step, State& state,
                               StageSolve& stages, Vector& increment) {
  if (!stages.solves_exactly())
    return advance_with_debt(problem, acting, step, state, stages, FailureMode::late, increment);
  Wait kept(state, 0), exact(state, 1);
  const auto try_exactly = [&] {
    if (exact.goes_on()) return false;
    const bool is_done = advance_exactly(problem, step, state, stages, increment);
    exact.record(!is_done);
    return is_done;
  };
  const bool exact_first = kept.goes_on();
  if (exact_first && try_exactly()) return;
  try {
    advance_with_debt(problem, acting, step, state, stages, FailureMode::early, increment);
    kept.record(false);
    return;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_converged) throw;
    if (log::enabled(log::Level::debug)) log::debug(std::string("kept factor: ") + error.what());
    kept.record(true);
  }
  if (!exact_first && try_exactly()) return;
  advance_with_debt(problem, acting, step, state, stages, FailureMode::late, increment);
}

}  // namespace ricochet
