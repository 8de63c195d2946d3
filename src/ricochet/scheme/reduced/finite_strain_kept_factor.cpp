#include "ricochet/scheme/reduced/finite_strain_kept_factor.hpp"

#include "ricochet/base/error.hpp"
#include "ricochet/scheme/reduced/massless_contact_step.hpp"

namespace ricochet {

/// Imposes contact at the end with the contact nodes, at δ = 0, at u_c1 + K_cc⁻¹ (L₁ + P_c(u₁) − f_c(u₁) − 2 b_c).
void KeptFactorEquations::require_contact(Stage& stage) {
  const SemidiscreteProblem& problem = iterate_.task().problem;
  Vector& end = iterate_.now().end;
  iterate_.find_end_residual(end_residual_);
  end_residual_ -= 2.0 * stage.right_hand_side.force;
  contact_right_hand_side_.resize(Index(problem.contact_dofs.size()));
  problem.gather_contact(end_residual_, contact_right_hand_side_);
  const Vector& shift =
      MasslessContactStep::solve_contact_nodes(problem, contact_right_hand_side_, iterate_.task().stages);
  for (const Index dof : problem.contact_dofs) end[dof] += shift[dof];
  // Conditions that follow the motion are linear about the end of the previous iteration: −m there, in place of δ = 0.
  linearization_motion_.setZero(end.size());
  for (const Index dof : problem.contact_dofs) linearization_motion_[dof] = 0.5 * (iterate_.last().end[dof] - end[dof]);
  iterate_.require_contact(end, linearization_motion_, stage);
  if (problem.contact.follows_motion()) stage.motion.reset();  // an iteration has the rows of its start
}

/// Throws Error(not_converged), which names a cell inverted by the displacements of this iteration, if any: operators
/// are meaningless there, and the error of a stage does not show the cause.
void KeptFactorEquations::throw_if_inverted() {
  const InternalForce& elastic = *iterate_.task().problem.internal_force;
  elastic.evaluate(iterate_.now().end, scratch_);
  elastic.evaluate(iterate_.now().middle, scratch_);
}

/// Solves the linear stage of an iteration.
void KeptFactorEquations::solve() {
  const StepTask& task = iterate_.task();
  Stage& stage = task.middle_stage();
  iterate_.begin_correction();
  iterate_.balance_middle(stage);
  if (!task.problem.has_contact_dofs()) {
    stage.conditions.eligible.clear();
    stage.motion.reset();
  } else {
    require_contact(stage);
  }
  try {
    solution_ = &task.stages.solve(MasslessContactStep::midpoint_stage(task.problem));
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::not_converged) throw_if_inverted();
    throw;
  }
}

/// Updates x += δ, u₁ += 2δ, on contact nodes 2m.
void KeptFactorEquations::correct() {
  const StepTask& task = iterate_.task();
  auto& [middle, end] = iterate_.now();
  middle += solution_->increment;
  next_end_ = 2.0 * middle - task.state.displacement;
  for (const Index dof : task.problem.contact_dofs) next_end_[dof] = end[dof] + 2.0 * solution_->contact_increment[dof];
  end = next_end_;
}

NewtonEquations::Iteration KeptFactorEquations::iterate() {
  solve();
  correct();
  return iterate_.sizes();
}

void KeptFactorEquations::accelerate() {
  const SemidiscreteProblem& problem = iterate_.task().problem;
  auto& [middle, end] = iterate_.now();
  const Index dofs = middle.size(), contact = Index(problem.contact_dofs.size());
  const auto gather = [&](const StepPositions& positions, Vector& values) {
    values.resize(dofs + contact);
    values.head(dofs) = positions.middle;
    problem.gather_contact(positions.end, values.tail(contact));
  };
  gather(iterate_.last(), point_);
  gather(iterate_.now(), image_);
  acceleration_.advance(point_, image_, image_);
  middle = image_.head(dofs);
  end = 2.0 * middle - iterate_.task().state.displacement;
  problem.scatter_contact(image_.tail(contact), end);
}

}  // namespace ricochet
