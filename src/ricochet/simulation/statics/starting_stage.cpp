#include "ricochet/simulation/statics/starting_stage.hpp"

#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

double largest(const SemidiscreteProblem& problem, const Vector& values) {
  return problem.ranks->maximum(values.size() > 0 ? values.lpNorm<Eigen::Infinity>() : 0.0);
}

Vector residual_force(const SemidiscreteProblem& problem, const Vector& displacement, const Vector& velocity) {
  Vector load, internal;
  problem.loads.total(0.0, load);
  if (problem.pressure) problem.pressure->add_force(displacement, 0.0, load);
  problem.internal_force->evaluate(displacement, internal);
  load -= internal;
  if (!problem.has_damping() || velocity.size() == 0) return load;
  Vector damping;
  problem.damping.evaluate(velocity, damping);
  load -= damping;
  return load;
}

Stage contact_stage(const SemidiscreteProblem& problem, const Vector& displacement, Vector right_hand_side) {
  Stage stage;
  stage.right_hand_side.force = std::move(right_hand_side);
  stage.right_hand_side.prescribed.setZero(problem.supports.size());
  if (!problem.internal_force->is_linear()) stage.linearization.displacement = displacement;
  require_no_penetration(problem, displacement, 0.0, stage);
  stage.has_obstacle_velocity = true;  // of obstacles at rest
  return stage;
}

}  // namespace ricochet
