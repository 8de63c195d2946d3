#include "ricochet/solver/stage_newton.hpp"

#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

void StageNewton::store_stage(const Stage& stage) {
  linearization_ = stage.linearization;
  evaluate(linearization_.displacement, force_at_base_);
  right_hand_side_ = stage.right_hand_side;
  conditions_ = stage.conditions;
  motion_ = stage.motion;
}

void StageNewton::evaluate(const Vector& displacement, Vector& force) {
  problem_.internal_force->evaluate(displacement, force);
  if (!problem_.pressure) return;
  follower_load_.setZero(force.size());
  problem_.pressure->add_force(displacement, linearization_.load_time, follower_load_, linearization_.load_part);
  force -= follower_load_;
}

/// Updates δ by a correction, and accelerates the iterations as NewtonProgress::wants_acceleration() advises.
void StageNewton::correct(const Vector& correction) {
  before_ = total_;
  total_ += correction;
  if (progress_.wants_acceleration()) acceleration_.advance(before_, total_, total_);
}

/// Evaluates f(p + κδ). If a correction inverts a cell, half of it is taken, then half of that.
void StageNewton::update_internal_force(double factor) {
  for (int halving = 0;; ++halving) {
    displacement_ = linearization_.displacement + factor * total_;
    try {
      evaluate(displacement_, force_);
      return;
    } catch (const Error& problem) {
      if (problem.kind() != ErrorKind::not_converged || halving == max_halvings) throw;
    }
    total_ = 0.5 * (total_ + before_);
  }
}

/// Sets the stage for a correction of δ = total.
void StageNewton::linearize(const OperatorCoefficients& coefficients, Stage& stage) {
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

void StageNewton::solve(const OperatorCoefficients& coefficients, double renewal_price, const SolveLinear& solve_linear,
                        const Renew& renew, Stage& stage, StageSolution& solution) {
  store_stage(stage);
  total_.setZero(problem_.dof_count());
  const double size = problem_.nodes.cwiseAbs().maxCoeff() + linearization_.displacement.lpNorm<Eigen::Infinity>();
  progress_.start(4.0 * std::numeric_limits<double>::epsilon() * size, renewal_price);
  acceleration_.restart();
  before_ = total_;
  int iterations = 0;
  while (true) {
    const bool was_frozen = has_frozen_rows();
    solve_linear(stage, solution);
    if (has_frozen_rows() != was_frozen) acceleration_.restart();  // corrections are those of another map from now on
    iterations += solution.iterations;
    const double correction = solution.increment.allFinite() ? solution.increment.lpNorm<Eigen::Infinity>()
                                                             : std::numeric_limits<double>::infinity();
    const NewtonProgress::Advice advice =
        progress_.assess(correction, (total_ + solution.increment).lpNorm<Eigen::Infinity>());
    if (advice == NewtonProgress::Advice::done) {
      total_ += solution.increment;
      break;
    }
    if (advice == NewtonProgress::Advice::failed) throw progress_.failure(correction);
    if (std::isfinite(correction)) correct(solution.increment);
    update_internal_force(coefficients.stiffness);
    if (advice == NewtonProgress::Advice::renew) {
      renew(displacement_);
      progress_.count_renewal();
      progress_.restart();
      acceleration_.restart();
    }
    linearize(coefficients, stage);
  }
  solution.increment = total_;
  if (problem_.pressure) {
    displacement_ = linearization_.displacement + coefficients.stiffness * total_;
    solution.follower_load.setZero(total_.size());
    problem_.pressure->add_force(displacement_, linearization_.load_time, solution.follower_load,
                                 linearization_.load_part);
  }
  solution.iterations = iterations;
  solution.newton_iterations = progress_.iterations();
}

}  // namespace ricochet
