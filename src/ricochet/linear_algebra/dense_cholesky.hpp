#pragma once

#include "ricochet/base/types.hpp"

/// @file Dense Cholesky factorization (LAPACK, on one thread, so that the bits are always the same).
namespace ricochet {

/// Cholesky factorization A = L Lᵀ.
class DenseCholesky {
 public:
  /// Reads the lower triangle and reuses its storage. Returns false if A is not positive definite.
  bool compute(const Matrix& matrix);
  /// Computes x = A⁻¹ b.
  void solve(const Vector& right, Vector& x) const;

 private:
  Matrix factor_;
};

}  // namespace ricochet
