#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/supernodal_factor.hpp"

/// @file Supernodal sparse Cholesky factorization. METIS orders, CHOLMOD tells the shape of the factor, and
/// NumericFactorization computes it.
namespace ricochet {

/// P (2ᵏA) Pᵀ = L Lᵀ. The power of two makes the factor the same bits in every unit system that differs by powers of
/// two (a square root would not be).
class SparseCholesky {
 public:
  /// Who computes the factor and solves with it: our own loops, or CHOLMOD (to compare).
  enum class Arithmetic { own, library };

  SparseCholesky();
  /// Analyses and factorizes a symmetric matrix stored whole. Does not throw when it is not positive definite: ask.
  explicit SparseCholesky(const SparseMatrix& matrix, Arithmetic arithmetic = Arithmetic::own);
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;
  ~SparseCholesky();

  /// Name and version of what tells the shape of the factor.
  [[nodiscard]] static std::string library();

  /// The two halves of the constructor. Between them `predicted` says what the second will take, and the lower triangle
  /// of the matrix is kept. `factorize` throws std::logic_error where nothing has been analysed since the last one.
  void analyse(const SparseMatrix& matrix);
  void factorize(Arithmetic arithmetic = Arithmetic::own);
  /// Factorizes another matrix of the same pattern, in the order that was found for the first: the bits of a new
  /// factor. Throws std::logic_error if it has an entry that does not fit into the factor. Where it is not positive
  /// definite, nothing may be solved before another one that is.
  void refactorize(const SparseMatrix& matrix);
  struct Prediction {
    bool possible = true;     ///< false: more entries than the library can count
    double entries = 0.0;     ///< of L
    double operations = 0.0;  ///< additions and multiplications of the factorization
  };
  [[nodiscard]] Prediction predicted() const;

  [[nodiscard]] Index size() const;
  [[nodiscard]] bool positive_definite() const;
  /// The unknown at which the factorization stopped, or −1.
  [[nodiscard]] Index failed_unknown() const;
  /// 2ᵏ above.
  [[nodiscard]] double scale() const;
  /// Entries of L as stored (supernodes are dense).
  [[nodiscard]] std::size_t factor_entries() const;
  /// Memory that a triangular solve reads.
  [[nodiscard]] std::size_t factor_bytes() const;
  /// The unknown at each place of the factor: P.
  [[nodiscard]] const std::vector<int>& permutation() const;
  /// The place of an unknown in the factor.
  [[nodiscard]] Index place(Index unknown) const;

  /// Length of the vectors y below: `size` entries in factor order, then work space.
  [[nodiscard]] Index work_size() const;
  /// y ← L⁻¹ y and y ← L⁻ᵀ y. Nothing is allocated.
  void solve_lower(Vector& y);
  void solve_upper(Vector& y);
  /// y = L⁻¹ P 2ᵏ b, with work space behind it.
  void forward(const Vector& right_hand_side, Vector& y);
  /// x = Pᵀ L⁻ᵀ y.
  void backward(const Vector& y, Vector& x);
  /// x = A⁻¹ b.
  void solve(const Vector& right_hand_side, Vector& x);

  /// The factor for sparse right-hand sides; its rows are places in the factor. Empty with Arithmetic::library.
  [[nodiscard]] const SupernodalFactor& supernodal() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
