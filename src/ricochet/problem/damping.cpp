#include "ricochet/problem/damping.hpp"

#include "ricochet/linear_algebra/diagonal_matrix.hpp"

namespace ricochet {

void Damping::set_mass_part(const SparseMatrix& matrix, const Points& nodes) {
  mass_part_.emplace(matrix, int(nodes.rows()));
}

void Damping::set_stiffness_part(const SparseMatrix& matrix, const Points& nodes) {
  stiffness_part_.emplace(matrix, nodes);
}

void Damping::evaluate(const Vector& velocity, Vector& force) const {
  if (mass_part_) {
    mass_part_->multiply(velocity, force);
  } else {
    force.setZero(velocity.size());
  }
  if (stiffness_part_) {
    stiffness_part_->evaluate(velocity, part_);
    force += part_;
  }
  if (ground_.size() > 0) force += ground_.cwiseProduct(velocity);
}

SparseMatrix Damping::matrix() const {
  SparseMatrix result;
  const auto add = [&](const SparseMatrix& part) { result = result.rows() == 0 ? part : SparseMatrix(result + part); };
  if (mass_part_) add(mass_part_->to_sparse());
  if (stiffness_part_) add(stiffness_part_->tangent());
  if (ground_.size() > 0) add(diagonal_matrix(ground_));
  return result;
}

}  // namespace ricochet
