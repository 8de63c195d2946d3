#include "ricochet/solver/stage_product.hpp"

#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/stage_operator.hpp"

namespace ricochet {

StageProduct::StageProduct(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                           const SparseMatrix& matrix, const Vector& displacement) {
  const bool is_damped = coefficients.damping != 0.0 && problem.has_damping();
  if (coefficients.mass != 0.0 && coefficients.stiffness != 0.0 && !is_damped) {
    SparseMatrix stiffness = stage_stiffness(problem, coefficients, displacement);
    // Ranks do alike.
    const double entries = problem.ranks->sum(static_cast<double>(matrix.nonZeros()));
    if (entries > most_growth_by_mass * problem.ranks->sum(static_cast<double>(stiffness.nonZeros()))) {
      stiffness *= coefficients.stiffness;
      matrix_ = NodeMatrix(stiffness, problem.dimension);
      mass_ = &problem.mass;
      mass_factor_ = coefficients.mass;
      return;
    }
  }
  matrix_ = NodeMatrix(matrix, problem.dimension);
}

void StageProduct::multiply(const Vector& x, Vector& y) const {
  matrix_.multiply(x, y);
  if (mass_ == nullptr) return;
  mass_->multiply(x, inertia_);
  y += mass_factor_ * inertia_;
}

SparseMatrix StageProduct::principal(const std::vector<Index>& nodes) const {
  SparseMatrix result = matrix_.principal(nodes);
  if (mass_ == nullptr) return result;
  SparseMatrix inertia = mass_->principal(nodes);
  inertia *= mass_factor_;
  return add_sparse(result, inertia);
}

Vector StageProduct::diagonal() const {
  if (mass_ == nullptr) return matrix_.diagonal();
  return matrix_.diagonal() + mass_factor_ * mass_->diagonal();
}

}  // namespace ricochet
