#pragma once

#include <memory>

#include "ricochet/base/types.hpp"

/// @file Symmetric factorization of matrices that need not be positive definite.
namespace ricochet {

/// Factorization A = Pᵀ L D Lᵀ P with a diagonal D, whose signs are those of the eigenvalues of A (Sylvester's law of
/// inertia). Pivots are taken in a fill-reducing order: a pivot of zero ends the factorization.
class IndefiniteFactor {
 public:
  IndefiniteFactor();
  ~IndefiniteFactor();
  IndefiniteFactor(const IndefiniteFactor&) = delete;
  IndefiniteFactor& operator=(const IndefiniteFactor&) = delete;

  /// Factorizes a symmetric matrix stored whole. Returns false if a pivot is zero, or not finite.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);
  /// Number of negative eigenvalues.
  [[nodiscard]] Index negative_eigenvalues() const;
  /// Computes x = A⁻¹ b.
  void solve(const Vector& right, Vector& x) const;
  /// Computes a vector x of length 1 with xᵀAx < 0, near an eigenvector of the negative eigenvalue nearest to zero. Its
  /// largest entry is positive. There must be a negative eigenvalue.
  void find_negative_direction(const SparseMatrix& matrix, Vector& x) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
