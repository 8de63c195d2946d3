#pragma once

#include "ricochet/base/types.hpp"

/// @file Dense Cholesky factorization (LAPACK, on one thread, so that the bits are always the same).
namespace ricochet {

/// A = L Lᵀ.
class DenseCholesky {
 public:
  /// Reads the lower triangle. Keeps its storage from call to call. False: A is not positive definite.
  bool compute(const Matrix& matrix);
  /// x = A⁻¹ b.
  void solve(const Vector& right, Vector& x) const;

 private:
  Matrix factor_;
};

}  // namespace ricochet
