#include "ricochet/scheme/alpha/nonsmooth_stages.hpp"

#include "ricochet/problem/contact_conditions.hpp"
#include "ricochet/scheme/response/contact_response.hpp"

namespace ricochet {

/// Solves M δ = Gᵀ normal for a jump of positions or velocities.
const StageSolution& NonsmoothStages::push(const SemidiscreteProblem& problem, const Vector& normal,
                                           StageSolve& stages) {
  unloaded_stage(problem, velocity_stage, stages);
  return solve_with_forces(problem, normal, velocity_stage, stages);
}

void NonsmoothStages::start(const SemidiscreteProblem& problem, State& state, StageSolve& stages) {
  Vector& load = state.memory[smooth_varying_load];
  load = Vector::Zero(problem.dof_count());
  if (problem.loads.varies()) problem.loads.varying(state.time, load);
  Vector& reaction = state.memory[smooth_support_reaction];
  reaction = state.forces.support_reaction;
  if (state.forces.normal_reaction.sum() > 0.0) {
    stages.stage(velocity_stage).rows = state.forces.rows;
    const StageSolution& pressed = push(problem, state.forces.normal_reaction, stages);
    state.acceleration -= pressed.increment;
    reaction -= pressed.support_reaction;
  }
  state.memory[algorithmic_acceleration] = state.acceleration;
}

void NonsmoothStages::position(const SemidiscreteProblem& problem, const State& state, double step,
                               const AlphaWeights& weights, StageSolve& stages) {
  const double h = step, end = state.time + h;
  smooth = state.acceleration;
  algorithmic = state.memory.at(algorithmic_acceleration);
  support = state.memory.at(smooth_support_reaction);
  shift_ = (weights.inertia * algorithmic - weights.force * smooth) / ((1.0 - weights.force) * weights.alpha);
  motion = h * state.velocity + (h * h * (0.5 - weights.beta)) * algorithmic - shift_;
  base_ = state.displacement + motion;
  Stage& stage = stages.stage(position_stage);
  equations_.balance(problem, end, base_, stage);
  equations_.prescribe_from(problem, end, base_, stage);
  require_no_penetration(problem, base_, end, stage);
  stage.slip_offset.resize(0);
  const StageSolution& solution = stages.solve(position_stage);
  motion += solution.increment;
  normal_ = solution.normal_reaction / weights.alpha;  // ν
  stages.stage(velocity_stage).rows = stage.rows;
  const StageSolution& pushed = push(problem, normal_, stages);
  jump = pushed.increment;
  smooth = weights.alpha * (solution.increment - jump);
  after = (solution.increment - shift_ - jump) / (weights.beta * h * h);
  change = after - algorithmic;
  mean_support = weights.force * support;
  support = solution.support_reaction - weights.alpha * pushed.support_reaction;
  mean_support += (1.0 - weights.force) * support;
}

const StageSolution& NonsmoothStages::impulses(const SemidiscreteProblem& problem, const State& state, double step,
                                               const AlphaWeights& weights, StageSolve& stages) {
  const double end = state.time + step;
  mean = (1.0 - weights.gamma) * algorithmic + weights.gamma * after;
  velocity = state.velocity + step * mean;
  base_ = state.displacement + motion;
  Stage& stage = unloaded_stage(problem, velocity_stage, stages);
  evaluate_obstacle_velocity(problem, base_, {end}, stage);
  equations_.require_impact_law(problem, base_, end, velocity, state.velocity, restitution_, step, stage);
  stage.gap_factor = 1.0;
  for (Index i = 0; i < normal_.size(); ++i) {
    if (normal_[i] > 0.0) stage.eligible[static_cast<std::size_t>(i)] = 1;
  }
  return stages.solve(velocity_stage);
}

}  // namespace ricochet
