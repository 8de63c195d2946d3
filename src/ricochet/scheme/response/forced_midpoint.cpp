#include "ricochet/scheme/response/forced_midpoint.hpp"

#include <fmt/format.h>

#include "ricochet/base/error.hpp"

namespace ricochet {

void ForcedMidpoint::analyse(const SemidiscreteProblem& problem) {
  Kane::analyse(problem);
  if (!problem.contact.has_friction() && !problem.contact.follows_motion()) return;
  throw Error(ErrorKind::invalid_input, fmt::format("scheme \"{}\" supports neither friction nor curved obstacles; "
                                                    "remove the friction, or use scheme \"reduced-kane\"",
                                                    name()));
}

double ForcedMidpoint::algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const {
  problem.gaps(state.displacement, state.time, gap_);
  return contact_energy(state.displacement, gap_);
}

void ForcedMidpoint::advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) {
  const double end = state.time + step();
  problem.gaps(state.displacement, state.time, before_);
  const double energy_before = contact_energy(state.displacement, before_);
  normal_.setZero(before_.size());
  Stage& stage = balance(problem, state, stages);
  evaluate_obstacle_velocity(problem, base(), {state.time + 0.5 * step(), step()}, stage);
  const StageSolution* solution = &solve_with_forces(problem, normal_, 0, stages);
  displacement_ = base() + solution->increment;
  problem.gaps(displacement_, end, free_);
  if (find_forces(problem, *stage.rows, {state, before_, displacement_, free_}, stages, normal_)) {
    balance(problem, state, stages);
    add_other_forces(stage.right_hand_side.force);
    solution = &solve_with_forces(problem, normal_, 0, stages);
  }
  solution_.increment = solution->increment;
  solution_.support_reaction = solution->support_reaction;
  solution_.normal_reaction = normal_;
  solution_.contact_status.resize(std::size_t(normal_.size()));
  for (Index i = 0; i < normal_.size(); ++i)
    solution_.contact_status[std::size_t(i)] = normal_[i] > 0.0 ? ContactStatus::slip : ContactStatus::open;
  advance_state(problem, stage, solution_, state, increment);
  problem.gaps(state.displacement, end, gap_);
  corrections_ = {.numerical_dissipation = lost(state.displacement, gap_)};
  corrections_.contact_work = other_work(increment) + contact_energy(state.displacement, gap_) - energy_before +
                              corrections_.numerical_dissipation;
}

}  // namespace ricochet
