#include "ricochet/linear_algebra/indefinite_factor.hpp"

#include <Eigen/SparseCholesky>

namespace ricochet {

namespace {

constexpr int inverse_iterations = 8;

}  // namespace

struct IndefiniteFactor::Implementation {
  Eigen::SimplicialLDLT<SparseMatrix> factor;
};

IndefiniteFactor::IndefiniteFactor() : implementation_(std::make_unique<Implementation>()) {}
IndefiniteFactor::~IndefiniteFactor() = default;

bool IndefiniteFactor::factorize(const SparseMatrix& matrix) {
  auto& factor = implementation_->factor;
  factor.compute(matrix);
  return factor.info() == Eigen::Success && factor.vectorD().allFinite() &&
         factor.vectorD().cwiseAbs().minCoeff() > 0.0;
}

Index IndefiniteFactor::negative_eigenvalues() const {
  return (implementation_->factor.vectorD().array() < 0.0).count();
}

void IndefiniteFactor::solve(const Vector& right, Vector& x) const { x = implementation_->factor.solve(right); }

/// With a pivot d < 0 of column k, x = Pᵀ L⁻ᵀ e_k has xᵀAx = d. Inverse iterations make x smooth.
void IndefiniteFactor::find_negative_direction(const SparseMatrix& matrix, Vector& x) const {
  const auto& factor = implementation_->factor;
  Index lowest = 0;
  factor.vectorD().minCoeff(&lowest);
  Vector pivot = Vector::Zero(matrix.rows());
  pivot[lowest] = 1.0;
  const Vector permuted = factor.matrixU().solve(pivot);
  x = factor.permutationPinv() * permuted;
  x.normalize();
  Vector next;
  for (int iteration = 0; iteration < inverse_iterations; ++iteration) {
    solve(x, next);
    next.normalize();
    if (!next.allFinite() || !(next.dot(matrix * next) < 0.0)) break;
    x = next;
  }
  Index largest = 0;
  x.cwiseAbs().maxCoeff(&largest);
  if (x[largest] < 0.0) x = -x;
}

}  // namespace ricochet
