#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/supernodal_factor.hpp"

/// @file Supernodal sparse Cholesky factorization. METIS orders the unknowns, CHOLMOD computes the structure of the
/// factor, and NumericFactorization its numbers.
namespace ricochet {

/// Factorization P (2ᵏA) Pᵀ = L Lᵀ. The power of two gives the factor the same bits in all unit systems that differ by
/// powers of two; without it, square roots would differ.
class SparseCholesky {
 public:
  /// Code that factorizes and solves: our own loops, or CHOLMOD (for comparison).
  enum class Arithmetic { own, library };

  SparseCholesky();
  /// Analyses and factorizes a symmetric matrix stored whole. Does not throw if it is not positive definite; see
  /// positive_definite().
  explicit SparseCholesky(const SparseMatrix& matrix, Arithmetic arithmetic = Arithmetic::own);
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;
  ~SparseCholesky();

  /// Name and version of the library that computes the structure of the factor.
  [[nodiscard]] static std::string library();

  /// The two halves of the constructor. Between them `predicted` reports the cost of the second, and the lower triangle
  /// of the matrix is kept. `factorize` throws std::logic_error if nothing has been analysed since its last call.
  void analyse(const SparseMatrix& matrix);
  void factorize(Arithmetic arithmetic = Arithmetic::own);
  /// Factorizes another matrix of the same pattern in the order found for the first, with the bits of a new factor.
  /// Throws std::logic_error if an entry does not fit into the factor. If the matrix is not positive definite, nothing
  /// may be solved until another one that is has been factorized.
  void refactorize(const SparseMatrix& matrix);
  struct Prediction {
    bool possible = true;     ///< false: more entries than the library can count
    double entries = 0.0;     ///< of L
    double operations = 0.0;  ///< additions and multiplications of the factorization
  };
  [[nodiscard]] Prediction predicted() const;

  [[nodiscard]] Index size() const;
  [[nodiscard]] bool positive_definite() const;
  /// Unknown at which the factorization stopped, or −1.
  [[nodiscard]] Index failed_unknown() const;
  /// The factor 2ᵏ above.
  [[nodiscard]] double scale() const;
  /// Number of stored entries of L (supernodes are dense).
  [[nodiscard]] std::size_t factor_entries() const;
  /// Memory that a triangular solve reads.
  [[nodiscard]] std::size_t factor_bytes() const;
  /// Permutation P: the unknown at each index of the factor.
  [[nodiscard]] const std::vector<int>& permutation() const;
  /// Index of an unknown in the factor.
  [[nodiscard]] Index factor_index(Index unknown) const;

  /// Length of the vectors y below: `size` entries in factor order, followed by work space.
  [[nodiscard]] Index work_size() const;
  /// Compute y ← L⁻¹ y and y ← L⁻ᵀ y without allocating.
  void solve_lower(Vector& y);
  void solve_upper(Vector& y);
  /// Computes y = L⁻¹ P 2ᵏ b, followed by work space.
  void forward(const Vector& right_hand_side, Vector& y);
  /// Computes x = Pᵀ L⁻ᵀ y.
  void backward(const Vector& y, Vector& x);
  /// Computes x = A⁻¹ b.
  void solve(const Vector& right_hand_side, Vector& x);

  /// Factor for sparse right-hand sides, whose rows are indices in the factor. Empty with Arithmetic::library.
  [[nodiscard]] const SupernodalFactor& supernodal() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
