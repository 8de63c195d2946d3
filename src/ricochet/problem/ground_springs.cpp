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

void GroundSprings::path_force(const Vector& middle, const Vector& increment, const PathRules& rules,
                               Vector& force) const {
  bodies_->path_force(middle, increment, rules, force);
  add(middle, force);
}

SparseMatrix GroundSprings::path_tangent(const Vector& middle, const Vector& increment, const PathRules& rules,
                                         const PathVariation& variation) const {
  return with_springs(bodies_->path_tangent(middle, increment, rules, variation), variation.middle);
}

SparseMatrix GroundSprings::tangent(const Vector& displacement) const {
  return with_springs(bodies_->tangent(displacement), 1.0);
}

/// Adds the stiffness of the springs times a factor.
SparseMatrix GroundSprings::with_springs(const SparseMatrix& of_bodies, double factor) const {
  Vector stiffness = Vector::Zero(of_bodies.rows());
  for (const auto& [dof, value] : springs_) stiffness[dof] = factor * value;
  return of_bodies + diagonal_matrix(stiffness);
}

}  // namespace ricochet
