#pragma once

#include <memory>

#include "ricochet/base/types.hpp"

/// @file Sparse LU factorization for large systems.
namespace ricochet {

/// Factorization of A with a fill-reducing ordering and partial pivoting (UMFPACK, from SuiteSparse). Unlike SparseLu
/// it prefers pivots on the diagonal if the pattern is nearly symmetric, as that of tangents, and is several times as
/// fast there. For tangents that are no longer positive definite.
class UnsymmetricFactor {
 public:
  UnsymmetricFactor();
  ~UnsymmetricFactor();
  UnsymmetricFactor(const UnsymmetricFactor&) = delete;
  UnsymmetricFactor& operator=(const UnsymmetricFactor&) = delete;

  /// Analyses a matrix; returns the estimated number of operations of a factorization. Throws std::bad_alloc.
  double analyse(const SparseMatrix& matrix);
  /// Factorizes the matrix that was analysed last. Returns false if it is singular, or not finite. Throws
  /// std::bad_alloc.
  [[nodiscard]] bool factorize();
  /// Computes x = A⁻¹ b.
  void solve(const Vector& right, Vector& x) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
