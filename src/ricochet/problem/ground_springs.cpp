#include "ricochet/problem/ground_springs.hpp"

#include "ricochet/linear_algebra/diagonal_matrix.hpp"

namespace ricochet {

GroundSprings::GroundSprings(std::shared_ptr<const InternalForce> bodies, const Vector& stiffness)
    : bodies_(std::move(bodies)) {
  for (Index dof = 0; dof < stiffness.size(); ++dof) {
    if (stiffness[dof] != 0.0) springs_.emplace_back(dof, stiffness[dof]);
  }
}

void GroundSprings::add(const Vector& displacement, Vector& force) const {
  for (const auto& [dof, stiffness] : springs_) force[dof] += stiffness * displacement[dof];
}

double GroundSprings::own_energy(const Vector& displacement) const {
  double sum = 0.0;
  for (const auto& [dof, stiffness] : springs_) sum += 0.5 * stiffness * displacement[dof] * displacement[dof];
  return sum;
}

void GroundSprings::evaluate(const Vector& displacement, Vector& force) const {
  bodies_->evaluate(displacement, force);
  add(displacement, force);
}

double GroundSprings::energy(const Vector& displacement) const {
  return bodies_->energy(displacement) + own_energy(displacement);
}

double GroundSprings::energy(const Vector& displacement, const Vector& force) const {
  return bodies_->energy(displacement, force) + own_energy(displacement);
}

/// Springs do not strain a body; if everything is linear, this force is the tangent times the increment.
void GroundSprings::strain_force(const Vector& displacement, const Vector& increment, Vector& force) const {
  bodies_->strain_force(displacement, increment, force);
  if (is_linear()) add(increment, force);
}

void GroundSprings::mean_force(const Vector& middle, const Vector& increment, Vector& force) const {
  bodies_->mean_force(middle, increment, force);
  add(middle, force);
}

void GroundSprings::mean_forces(const Vector& middle, const Vector& increment, Vector& force, Vector& of_strain) const {
  bodies_->mean_forces(middle, increment, force, of_strain);
  add(middle, force);
}

SparseMatrix GroundSprings::tangent(const Vector& displacement) const {
  const SparseMatrix of_bodies = bodies_->tangent(displacement);
  Vector stiffness = Vector::Zero(of_bodies.rows());
  for (const auto& [dof, value] : springs_) stiffness[dof] = value;
  return of_bodies + diagonal_matrix(stiffness);
}

}  // namespace ricochet
