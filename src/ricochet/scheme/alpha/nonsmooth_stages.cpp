#include "ricochet/scheme/alpha/nonsmooth_stages.hpp"

#include "ricochet/scheme/response/contact_response.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

/// Solves M δ = Gᵀ multiplier + support reactions, with δ = 0 on supported dofs. δ is the jump Q of the positions if
/// the multiplier is ν, and an acceleration if it is a contact force.
const StageSolution& NonsmoothStages::solve_jump(const SemidiscreteProblem& problem, const Vector& multiplier,
                                                 StageSolve& stages) {
  unloaded_stage(problem, velocity_stage, stages);
  return solve_with_forces(problem, multiplier, velocity_stage, stages);
}

void NonsmoothStages::start(const SemidiscreteProblem& problem, State& state, StageSolve& stages) {
  Vector& load = state.memory[smooth_varying_load];
  load = Vector::Zero(problem.dof_count());
  if (problem.loads.varies()) problem.loads.varying(state.time, load);
  Vector& reaction = state.memory[smooth_support_reaction];
  reaction = state.forces.support_reaction;
  if (problem.ranks->any(state.forces.normal_reaction.sum() > 0.0)) {
    stages.stage(velocity_stage).rows = state.forces.rows;
    const StageSolution& of_contact = solve_jump(problem, state.forces.normal_reaction, stages);
    state.acceleration -= of_contact.increment;
    reaction -= of_contact.support_reaction;
  }
  state.memory[algorithmic_acceleration] = state.acceleration;
}

void NonsmoothStages::solve_positions(const SemidiscreteProblem& problem, const State& state, double step,
                                      const AlphaWeights& weights, StageSolve& stages) {
  const double h = step, end = state.time + h;
  acceleration_without_contact = state.acceleration;
  algorithmic_start = state.dof_memory(algorithmic_acceleration);
  support_reaction_without_contact = state.memory.at(smooth_support_reaction, problem.supports.size());
  shift_ = (weights.inertia_weight * algorithmic_start - weights.force_weight * acceleration_without_contact) /
           ((1.0 - weights.force_weight) * weights.alpha);
  displacement_increment = h * state.velocity + (h * h * (0.5 - weights.beta)) * algorithmic_start - shift_;
  base_ = state.displacement + displacement_increment;
  Stage& stage = stages.stage(position_stage);
  equations_.balance(problem, end, base_, stage);
  equations_.prescribe_from(problem, end, base_, stage);
  require_no_penetration(problem, base_, end, stage);
  stage.conditions.slip.offset.resize(0);
  const StageSolution& solution = stages.solve(position_stage);
  displacement_increment += solution.increment;
  position_multiplier_ = solution.normal_reaction / weights.alpha;
  stages.stage(velocity_stage).rows = stage.rows;
  const StageSolution& jump = solve_jump(problem, position_multiplier_, stages);
  position_jump = jump.increment;
  acceleration_without_contact = weights.alpha * (solution.increment - position_jump);
  algorithmic_end = (solution.increment - shift_ - position_jump) / (weights.beta * h * h);
  algorithmic_increment = algorithmic_end - algorithmic_start;
  mean_support_reaction = weights.force_weight * support_reaction_without_contact;
  support_reaction_without_contact = solution.support_reaction - weights.alpha * jump.support_reaction;
  mean_support_reaction += (1.0 - weights.force_weight) * support_reaction_without_contact;
}

const StageSolution& NonsmoothStages::solve_velocities(const SemidiscreteProblem& problem, const State& state,
                                                       double step, const AlphaWeights& weights, StageSolve& stages) {
  const double end = state.time + step;
  algorithmic_mean = (1.0 - weights.gamma) * algorithmic_start + weights.gamma * algorithmic_end;
  predicted_velocity = state.velocity + step * algorithmic_mean;
  base_ = state.displacement + displacement_increment;
  Stage& stage = unloaded_stage(problem, velocity_stage, stages);
  evaluate_obstacle_velocity(problem, base_, {end}, stage);
  equations_.require_impact_law(problem, base_, end, predicted_velocity, state.velocity, 1.0, restitution_, step,
                                stage);
  for (Index i = 0; i < position_multiplier_.size(); ++i) {
    if (position_multiplier_[i] > 0.0) stage.conditions.eligible[std::size_t(i)] = 1;
  }
  return stages.solve(velocity_stage);
}

}  // namespace ricochet
