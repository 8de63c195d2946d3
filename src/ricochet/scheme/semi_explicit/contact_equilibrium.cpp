#include "ricochet/scheme/semi_explicit/contact_equilibrium.hpp"

#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

void ContactEquilibrium::analyse(const SemidiscreteProblem& problem) {
  stiffness_.analyse(problem);
  const Index dofs = problem.dof_count();
  std::vector<char> is_near(static_cast<std::size_t>(dofs), 0);
  for (Index row = 0; row < stiffness_.rows().rows(); ++row) {
    for (SparseRowMatrix::InnerIterator entry(stiffness_.rows(), row); entry; ++entry)
      is_near[std::size_t(entry.col())] = 1;
  }
  contact_node_dofs_ = ricochet::contact_node_dofs(problem);
  for (const Index dof : contact_node_dofs_) is_near[std::size_t(dof)] = 1;
  near_dofs_.clear();
  for (Index dof = 0; dof < dofs; ++dof) {
    if (is_near[std::size_t(dof)] != 0) near_dofs_.push_back(dof);
  }
  for (Vector* values : {&predicted_, &base_, &middle_, &rate_}) values->setZero(dofs);
}

void ContactEquilibrium::predict(const SemidiscreteProblem& problem, const State& state, const Vector& supported_next,
                                 double step) {
  for (const Index dof : near_dofs_) {
    predicted_[dof] = step * (state.velocity[dof] + (0.5 * step) * state.acceleration[dof]);
  }
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const Index dof = problem.supports.dofs()[std::size_t(i)];
    predicted_[dof] = supported_next[i] - state.displacement[dof];
  }
  for (const Index dof : contact_node_dofs_) {
    base_[dof] = state.displacement[dof] + predicted_[dof];
    middle_[dof] = state.displacement[dof] + 0.5 * predicted_[dof];
    rate_[dof] = predicted_[dof] / step;
  }
}

void ContactEquilibrium::require(const SemidiscreteProblem& problem, const State& state, const Vector& force,
                                 const Vector& load, const Vector& supported_next, double step, Stage& stage) {
  predict(problem, state, supported_next, step);
  stiffness_.multiply(predicted_, row_force_);
  if (stage.right_hand_side.force.size() != problem.dof_count())
    stage.right_hand_side.force.setZero(problem.dof_count());
  for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i) {
    const Index dof = problem.contact_dofs[i];
    stage.right_hand_side.force[dof] = load[dof] - force[dof] - row_force_[Index(i)];
  }
  stage.right_hand_side.prescribed.setZero(problem.supports.size());  // prescribed displacements are in the base
  require_no_penetration(problem, base_, state.time + step, stage);
  evaluate_obstacle_velocity(problem, middle_, {state.time + 0.5 * step, step, 0.5}, stage);
  require_friction(problem, rate_, 1.0 / step, stage);
}

}  // namespace ricochet
