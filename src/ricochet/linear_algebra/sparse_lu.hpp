#pragma once

#include <memory>

#include "ricochet/base/types.hpp"

/// @file Sparse LU factorization.
namespace ricochet {

/// Factorization P_r A P_c = L U, supernodal with partial pivoting, columns ordered by COLAMD (Eigen's SparseLU). The
/// ordering is reused for matrices of the same pattern.
class SparseLu {
 public:
  SparseLu();
  SparseLu(SparseLu&&) noexcept;
  SparseLu& operator=(SparseLu&&) noexcept;
  ~SparseLu();

  /// Factorizes A. Entries that are zero now but may not be later must be stored. Returns false if A is exactly
  /// singular.
  bool compute(const SparseMatrix& matrix);
  /// Discards the ordering, since the next matrix has another pattern.
  void reset();
  /// Computes x = A⁻¹ b.
  void solve(const Vector& right, Vector& x) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
