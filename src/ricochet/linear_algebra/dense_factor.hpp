#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Dense operations that OpenBLAS performs several times as fast as Eigen's generic code, on one thread, so that
/// the bits are always the same.
namespace ricochet {

/// Computes C += AᵀB for parts of larger matrices, `rows` × `left_columns` and `rows` × `right_columns`, each with its
/// column stride.
void add_transposed_product(Index rows, Index left_columns, Index right_columns, const double* left, Index left_stride,
                            const double* right, Index right_stride, double* result, Index result_stride);

/// Computes y = Aᵀ x.
void multiply_transposed(const Matrix& matrix, const Vector& x, double* y);

/// LU factorization P A = L U with partial pivoting.
class DenseLu {
 public:
  /// Factorizes A; reuses its storage.
  void compute(const Matrix& matrix);
  /// Computes x = A⁻¹ b; not finite if A is singular.
  void solve(const Vector& right, Vector& x) const;
  /// Smallest |pivot|; zero if A is exactly singular.
  [[nodiscard]] double smallest_pivot() const;

 private:
  Matrix factors_;
  std::vector<int> permutation_;
};

/// LU factorization in single precision: twice as fast, and accurate to six digits. Serves as a preconditioner.
class SingleLu {
 public:
  /// Rounds A and factorizes it. Returns false if it is not finite, or singular in single precision.
  bool compute(const Matrix& matrix);
  /// Computes x ≈ A⁻¹ b.
  void solve(const Vector& right, Vector& x) const;
  [[nodiscard]] Index size() const { return factors_.rows(); }

 private:
  Eigen::MatrixXf factors_;
  std::vector<int> permutation_;
  mutable Eigen::VectorXf solution_;
};

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

/// Computes y = A x.
void multiply_dense(const Matrix& matrix, const Vector& x, Vector& y);

}  // namespace ricochet
