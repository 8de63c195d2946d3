#include "ricochet/scheme/step_equations.hpp"

#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

void StepEquations::balance(const SemidiscreteProblem& problem, double time, const Vector& base, Stage& stage) {
  time_ = time;
  problem.internal_force->evaluate(base, force_);
  problem.loads.total(time, stage.right_hand_side.force);
  if (problem.pressure) problem.pressure->add_force(base, time, stage.right_hand_side.force);
  stage.linearization.load_time = time;
  stage.right_hand_side.force -= force_;
  if (!problem.internal_force->is_linear()) stage.linearization.displacement = base;
}

void StepEquations::balance(const SemidiscreteProblem& problem, double time, const Vector& base, const Vector& velocity,
                            Stage& stage) {
  balance(problem, time, base, stage);
  resist(problem, velocity, stage);
}

void StepEquations::balance_with(const SemidiscreteProblem& problem, const Vector& load, const Vector& base,
                                 const Vector& velocity, Stage& stage) {
  problem.internal_force->evaluate(base, force_);
  stage.right_hand_side.force = load - force_;
  if (!problem.internal_force->is_linear()) stage.linearization.displacement = base;
  resist(problem, velocity, stage);
}

void StepEquations::resist(const SemidiscreteProblem& problem, const Vector& velocity, Stage& stage) {
  if (!problem.has_damping()) return;
  problem.damping.evaluate(velocity, damping_force_);
  stage.right_hand_side.force -= damping_force_;
}

void StepEquations::observe_step(const SemidiscreteProblem& problem, const Vector& start, double start_time,
                                 const Vector& end, double step, Stage& stage) {
  if (!problem.has_moving_obstacles()) return;
  middle_ = 0.5 * (start + end);
  evaluate_obstacle_velocity(problem, middle_, {start_time + 0.5 * step, step, 0.5 * stage.conditions.gap.factor},
                             stage);
}

void StepEquations::require_impact_law(const SemidiscreteProblem& problem, const Vector& displacement, double time,
                                       const Vector& after, const Vector& before, double gap_factor, double restitution,
                                       double step, Stage& stage) {
  impact_ = stage.obstacle;
  impact_.normal *= 1.0 + restitution;
  impact_.in_space *= 1.0 + restitution;
  rate_ = after + restitution * before;
  require_no_approach(problem, displacement, time, rate_, gap_factor, impact_, step, stage);
}

void StepEquations::require_friction_beside_rates(const SemidiscreteProblem& problem, const Vector& velocity,
                                                  double slip_factor, Stage& stage) {
  require_friction(problem, velocity, slip_factor, stage);
  if (stage.conditions.slip.offset.size() > 0) stage.conditions.slip.rounding = stage.conditions.gap.rounding;
}

void StepEquations::require_friction_over_step(const SemidiscreteProblem& problem, const State& state,
                                               const Vector& predicted, double step, Stage& stage) {
  if (problem.has_moving_obstacles()) {
    middle_ = state.displacement + 0.5 * predicted;
    evaluate_obstacle_velocity(problem, middle_, {state.time + 0.5 * step, step, 0.5 * stage.conditions.gap.factor},
                               stage);
  }
  if (!problem.contact.has_friction()) return;
  rate_ = predicted / step;
  require_friction(problem, rate_, 1.0 / step, stage);
}

void StepEquations::store_forces(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution,
                                 double step, const Vector& motion, double rate, State& state) const {
  store_contact(stage, solution, step, state);
  store_loads(problem, solution, motion, rate, state.forces);
}

void StepEquations::store_contact(const Stage& stage, const StageSolution& solution, double step, State& state) {
  store_reactions(stage, solution, step, state.forces, state.obstacle_increment);
  state.contact_status = solution.contact_status;
}

void StepEquations::store_other_stage(const SemidiscreteProblem& problem, const Stage& stage,
                                      const StageSolution& solution, double step, const Vector& motion, double rate,
                                      OtherStageForces& part) const {
  store_reactions(stage, solution, step, part.forces, part.obstacle_increment);
  store_loads(problem, solution, motion, rate, part.forces);
}

void StepEquations::store_loads(const SemidiscreteProblem& problem, const StageSolution& solution, const Vector& motion,
                                double rate, StepForces& forces) const {
  if (problem.loads.varies() || problem.pressure) problem.loads.varying(time_, forces.varying_load);
  if (problem.pressure) forces.varying_load += solution.follower_load;
  if (!problem.has_damping()) return;
  problem.damping.evaluate(motion, forces.damping_force);
  forces.damping_force *= rate;
}

void StepEquations::store_reactions(const Stage& stage, const StageSolution& solution, double step, StepForces& forces,
                                    ObstacleMotion& travel) {
  if (forces.rows != stage.rows) forces.rows = stage.rows;
  static_cast<Reactions&>(forces) = solution;
  if (stage.obstacle.normal.size() == 0) return;
  travel.normal = step * stage.obstacle.normal;
  travel.tangential = step * stage.obstacle.tangential;
  if (stage.obstacle.in_space.size() == 0) return;
  travel.in_space = step * stage.obstacle.in_space;
  project_motion(*stage.rows, travel);
}

Stage& unloaded_stage(const SemidiscreteProblem& problem, std::size_t number, StageSolve& stages) {
  Stage& stage = stages.stage(number);
  stage.right_hand_side.force.setZero(problem.dof_count());
  stage.right_hand_side.prescribed.setZero(problem.supports.size());
  return stage;
}

double elastic_product(const SemidiscreteProblem& problem, const Vector& x, const Vector& y, Vector& force) {
  problem.internal_force->evaluate(x, force);
  return y.dot(force);
}

void follow_without_inertia(const SemidiscreteProblem& problem, const Vector& increment, double step, State& state) {
  for (const Index dof : problem.massless_dofs) {
    state.velocity[dof] = increment[dof] / step;
    state.acceleration[dof] = 0.0;
  }
}

}  // namespace ricochet
