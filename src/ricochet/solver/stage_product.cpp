#include "ricochet/solver/stage_product.hpp"

#include "ricochet/solver/stage_operator.hpp"

namespace ricochet {

namespace {

/// A sum of K and M is worth it where it has hardly more entries than K.
constexpr double most_growth = 1.3;

}  // namespace

StageProduct::StageProduct(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                           const SparseMatrix& matrix, const Vector& displacement) {
  const bool is_damped = coefficients.damping != 0.0 && problem.has_damping();
  if (coefficients.mass != 0.0 && coefficients.stiffness != 0.0 && !is_damped) {
    SparseMatrix stiffness = stage_stiffness(problem, coefficients, displacement);
    if (static_cast<double>(matrix.nonZeros()) > most_growth * static_cast<double>(stiffness.nonZeros())) {
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

}  // namespace ricochet
