#include "ricochet/solver/stage_product.hpp"

namespace ricochet {

namespace {

/// A sum of K and M is worth it where it has hardly more entries than K.
constexpr double most_growth = 1.3;

}  // namespace

StageProduct::StageProduct(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                           const SparseMatrix& matrix) {
  const auto order = problem.mass.shared_order();
  const bool is_damped = coefficients.damping != 0.0 && problem.has_damping();
  if (coefficients.mass != 0.0 && coefficients.stiffness != 0.0 && !is_damped) {
    SparseMatrix stiffness = problem.internal_force->tangent();
    if (static_cast<double>(matrix.nonZeros()) > most_growth * static_cast<double>(stiffness.nonZeros())) {
      stiffness *= coefficients.stiffness;
      matrix_ = NodeMatrix(stiffness, problem.dimension, order);
      mass_ = &problem.mass;
      mass_factor_ = coefficients.mass;
      return;
    }
  }
  matrix_ = NodeMatrix(matrix, problem.dimension, order);
}

void StageProduct::multiply(const Vector& x, Vector& y) const {
  matrix_.to_order(x, ordered_x_);
  matrix_.multiply_ordered(ordered_x_, ordered_y_);
  if (mass_ != nullptr) {
    mass_->multiply_ordered(ordered_x_, inertia_);
    ordered_y_ += mass_factor_ * inertia_;
  }
  matrix_.from_order(ordered_y_, y);
}

}  // namespace ricochet
