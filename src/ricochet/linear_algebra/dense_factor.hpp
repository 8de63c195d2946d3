#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Dense operations that OpenBLAS does several times as fast as Eigen's generic code. On one thread, so that the
/// bits are always the same.
namespace ricochet {

/// C += AᵀB on parts of larger matrices: `rows` × `left_columns`, `rows` × `right_columns`, each with the distance
/// from one column to the next.
void add_transposed_product(Index rows, Index left_columns, Index right_columns, const double* left, Index left_stride,
                            const double* right, Index right_stride, double* result, Index result_stride);

/// y = Aᵀ x.
void multiply_transposed(const Matrix& matrix, const Vector& x, double* y);

/// P A = L U with partial pivoting.
class DenseLu {
 public:
  /// Keeps its storage from call to call.
  void compute(const Matrix& matrix);
  /// x = A⁻¹ b; not finite where A is singular.
  void solve(const Vector& right, Vector& x) const;
  /// The least |pivot|; zero where A is exactly singular.
  [[nodiscard]] double smallest_pivot() const;

 private:
  Matrix factors_;
  std::vector<int> permutation_;
};

/// The same in single precision: twice as fast, and good for the first six digits. A preconditioner.
class SingleLu {
 public:
  /// Rounds A and factorizes it. False: not finite, or singular in single precision.
  bool compute(const Matrix& matrix);
  /// x ≈ A⁻¹ b.
  void solve(const Vector& right, Vector& x) const;
  [[nodiscard]] Index size() const { return factors_.rows(); }

 private:
  Eigen::MatrixXf factors_;
  std::vector<int> permutation_;
  mutable Eigen::VectorXf solution_;
};

/// y = A x.
void multiply_dense(const Matrix& matrix, const Vector& x, Vector& y);

}  // namespace ricochet
