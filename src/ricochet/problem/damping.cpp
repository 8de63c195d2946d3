#include "ricochet/problem/damping.hpp"

namespace ricochet {

void Damping::set_mass_part(const SparseMatrix& matrix, const Points& nodes) {
  mass_part_.emplace(matrix, static_cast<int>(nodes.rows()));
}

void Damping::set_stiffness_part(const SparseMatrix& matrix, const Points& nodes) {
  stiffness_part_.emplace(matrix, nodes);
}

void Damping::evaluate(const Vector& velocity, Vector& force) const {
  if (!mass_part_) return stiffness_part_->evaluate(velocity, force);
  mass_part_->multiply(velocity, force);
  if (!stiffness_part_) return;
  stiffness_part_->evaluate(velocity, part_);
  force += part_;
}

SparseMatrix Damping::matrix() const {
  if (!mass_part_) return stiffness_part_->tangent();
  if (!stiffness_part_) return mass_part_->whole();
  return mass_part_->whole() + stiffness_part_->tangent();
}

}  // namespace ricochet
