#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Supernodal sparse Cholesky factorization (CHOLMOD, METIS), with chosen unknowns ordered last.
namespace ricochet {

/// P (2ᵏA) Pᵀ = L Lᵀ. The power of two makes the factor the same bits in every unit system that differs by powers of
/// two (a square root would not be). The trailing unknowns keep their given order and come last, so the trailing block
/// of L is the Cholesky factor of the Schur complement on them.
class SparseCholesky {
 public:
  /// Analyses and factorizes a symmetric matrix stored whole. Does not throw when it is not positive definite: ask.
  explicit SparseCholesky(const SparseMatrix& matrix, const std::vector<Index>& trailing = {});
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;
  ~SparseCholesky();

  [[nodiscard]] Index size() const;
  [[nodiscard]] bool positive_definite() const;
  /// The unknown at which the factorization stopped, or −1.
  [[nodiscard]] Index failed_unknown() const;
  /// 2ᵏ above.
  [[nodiscard]] double scale() const;
  /// Entries of L as stored (supernodes are dense).
  [[nodiscard]] std::size_t factor_entries() const;

  /// y = L⁻¹ P 2ᵏ b, in factor order. Allocates on the first call only.
  void forward(const Vector& right_hand_side, Vector& y);
  /// x = Pᵀ L⁻ᵀ y.
  void backward(const Vector& y, Vector& x);
  /// x = A⁻¹ b.
  void solve(const Vector& right_hand_side, Vector& x);
  /// The lower triangular trailing block of L, trailing × trailing.
  [[nodiscard]] Matrix trailing_factor() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The rows and columns of a symmetric matrix whose `number` is not negative, renumbered by it (`size` of them).
[[nodiscard]] SparseMatrix extract(const SparseMatrix& matrix, const std::vector<int>& row_number, Index rows,
                                   const std::vector<int>& column_number, Index columns);

}  // namespace ricochet
