#pragma once

#include <cmath>

#include "ricochet/base/types.hpp"

/// @file GMRES for systems with a good preconditioner, so that a few iterations suffice.
namespace ricochet {

/// GMRES without restart (Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856–869), preconditioned from the
/// right, so that the residual is that of the system itself. Reuses its storage.
class Gmres {
 public:
  /// Solves A z = r for a correction z: multiply(x, y) computes y = A x, precondition(x, y) computes y ≈ A⁻¹ x. Stops
  /// when the residual is at most `reduction` · |r|, or after `limit` iterations. Returns the reduction reached.
  template <typename Multiply, typename Precondition>
  double solve(const Multiply& multiply, const Precondition& precondition, const Vector& right, double reduction,
               Index limit, Vector& correction) {
    const Index size = right.size();
    if (basis_.rows() != size || basis_.cols() < limit + 1) basis_.resize(size, limit + 1);
    if (hessenberg_.cols() < limit) {
      hessenberg_.resize(limit + 1, limit);
      cosine_.resize(limit);
      sine_.resize(limit);
      rotated_.resize(limit + 1);
    }
    correction.setZero(size);
    iterations_ = 0;
    const double start = right.norm();
    if (!(start > 0.0)) return 0.0;
    basis_.col(0) = right / start;
    rotated_[0] = start;
    double left = start;
    while (iterations_ < limit && left > reduction * start) {
      const Index k = iterations_++;
      direction_ = basis_.col(k);
      precondition(direction_, preconditioned_);
      multiply(preconditioned_, direction_);
      left = extend(k);
      if (!std::isfinite(left)) return left;
    }
    weights_.resize(iterations_);
    for (Index i = iterations_ - 1; i >= 0; --i) {
      double sum = rotated_[i];
      for (Index j = i + 1; j < iterations_; ++j) sum -= hessenberg_(i, j) * weights_[j];
      weights_[i] = sum / hessenberg_(i, i);
    }
    direction_.noalias() = basis_.leftCols(iterations_) * weights_;
    precondition(direction_, correction);
    return left / start;
  }
  [[nodiscard]] Index iterations() const { return iterations_; }

 private:
  /// Adds a column to the orthonormal basis and reduces the Hessenberg matrix to triangular form by rotations. Returns
  /// the norm of the residual.
  double extend(Index k);

  Matrix basis_, hessenberg_;
  Vector cosine_, sine_, rotated_, weights_, direction_, preconditioned_, projections_;
  Index iterations_ = 0;
};

}  // namespace ricochet
