#pragma once

#include <memory>

#include "ricochet/base/types.hpp"

/// @file Sparse LU factorization.
namespace ricochet {

/// P_r A P_c = L U, supernodal with partial pivoting, columns ordered by COLAMD (Eigen's SparseLU). The order is kept
/// from one matrix to the next of the same pattern.
class SparseLu {
 public:
  SparseLu();
  SparseLu(SparseLu&&) noexcept;
  SparseLu& operator=(SparseLu&&) noexcept;
  ~SparseLu();

  /// Entries that are zero now and may not be later must be stored. False: A is exactly singular.
  bool compute(const SparseMatrix& matrix);
  /// The next matrix has another pattern.
  void reset();
  /// x = A⁻¹ b.
  void solve(const Vector& right, Vector& x) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
