#include "ricochet/solver/stage_newton.hpp"

#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

void StageNewton::store_stage(const Stage& stage) {
  linearization_ = stage.linearization;
  find_force(linearization_.displacement, force_at_base_);
  right_hand_side_ = stage.right_hand_side;
  conditions_ = stage.conditions;
  motion_ = stage.motion;
}

/// Computes f less the follower loads.
void StageNewton::find_force(const Vector& displacement, Vector& force) {
  problem_.internal_force->evaluate(displacement, force);
  if (!problem_.pressure) return;
  follower_load_.setZero(force.size());
  problem_.pressure->add_force(displacement, linearization_.load_time, follower_load_, linearization_.load_part);
  force -= follower_load_;
}

void StageNewton::evaluate() {
  displacement_ = linearization_.displacement + task_->coefficients.stiffness * total_;
  find_force(displacement_, force_);
}

/// Sets the stage for a correction of δ = total.
void StageNewton::linearize() {
  const OperatorCoefficients& coefficients = task_->coefficients;
  Stage& stage = *stage_;
  problem_.mass.multiply(total_, inertial_force_);
  stage.right_hand_side.force =
      right_hand_side_.force - coefficients.mass * inertial_force_ - (force_ - force_at_base_);
  if (problem_.has_damping()) {
    problem_.damping.evaluate(total_, damping_force_);
    stage.right_hand_side.force -= coefficients.damping * damping_force_;
  }
  stage.right_hand_side.prescribed = right_hand_side_.prescribed;
  for (Index i = 0; i < problem_.supports.size(); ++i)
    stage.right_hand_side.prescribed[i] -= total_[problem_.supports.dofs()[std::size_t(i)]];
  if (stage.motion) {
    stage.motion->move_origin(*motion_, conditions_, total_);
    zero_motion_.setZero(total_.size());
    linearize_contact(problem_, zero_motion_, stage);
    return;
  }
  stage.rows->normal_motion(total_, stage.conditions.gap.offset);
  stage.conditions.gap.offset = conditions_.gap.offset + stage.conditions.gap.factor * stage.conditions.gap.offset;
  if (stage.conditions.slip.offset.size() == 0) return;
  stage.rows->tangential_motion(total_, stage.conditions.slip.offset);
  stage.conditions.slip.offset = conditions_.slip.offset + stage.conditions.slip.factor * stage.conditions.slip.offset;
}

NewtonEquations::Iteration StageNewton::iterate() {
  linearize();
  task_->solve_linear(*stage_, *solution_);
  contact_iterations_ += solution_->iterations;
  before_ = total_;
  if (!solution_->increment.allFinite()) return {std::numeric_limits<double>::infinity(), 0.0};
  total_ += solution_->increment;
  return {solution_->increment.lpNorm<Eigen::Infinity>(), total_.lpNorm<Eigen::Infinity>()};
}

void StageNewton::solve(const Task& task, Stage& stage, StageSolution& solution) {
  task_ = &task;
  stage_ = &stage;
  solution_ = &solution;
  contact_iterations_ = 0;
  if (task.debt.is_due(task.renewal_price)) task.renew(stage.linearization.displacement);
  store_stage(stage);
  force_ = force_at_base_;
  before_ = total_.setZero(problem_.dof_count());
  const double size = problem_.nodes.cwiseAbs().maxCoeff() + linearization_.displacement.lpNorm<Eigen::Infinity>();
  newton_.solve(*this, {4.0 * std::numeric_limits<double>::epsilon() * size, task.renewal_price}, Persistence::full);
  solution.increment = total_;
  if (problem_.pressure) {
    displacement_ = linearization_.displacement + task.coefficients.stiffness * total_;
    solution.follower_load.setZero(total_.size());
    problem_.pressure->add_force(displacement_, linearization_.load_time, solution.follower_load,
                                 linearization_.load_part);
  }
  solution.iterations = contact_iterations_;
  solution.newton_iterations = newton_.progress().iterations();
  if ((solution.normal_reaction.array() > 0.0).any()) task.debt.add_step(solution.newton_iterations);
}

}  // namespace ricochet
