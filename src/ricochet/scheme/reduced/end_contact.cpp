#include "ricochet/scheme/reduced/end_contact.hpp"

#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

void EndContact::require(const SemidiscreteProblem& problem, ReactionMean mean, double step, const State& state,
                         const Vector& end_displacement, StepEquations& equations, Stage& stage) {
  const StepStart start{state.displacement, state.time};
  require_no_penetration(problem, end_displacement, state.time + step, stage, &start);
  stage.conditions.gap.factor = 2.0;
  equations.observe_step(problem, state.displacement, state.time, end_displacement, step, stage);
  rate_ = (end_displacement - state.displacement) / step;
  require_friction(problem, rate_, 2.0 / step, stage);
  stick_.require(problem, state, step, stage);
  if (mean == ReactionMean::end) return;
  problem.gaps(state.displacement, state.time, stage.start.gap);
  stage.start.normal_reaction = state.forces.normal_reaction;
  stage.start.tangential_reaction = state.forces.tangential_reaction;
}

}  // namespace ricochet
