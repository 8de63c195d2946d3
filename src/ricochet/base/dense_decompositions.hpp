#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <optional>

#include "ricochet/base/types.hpp"

/// @file Eigen's decompositions of small dense matrices, instantiated once: each file that instantiates one itself
/// costs the compiler two to ten seconds.
namespace ricochet {

/// Cholesky factorization A = L Lᵀ. Reads the lower triangle.
class SmallCholesky {
 public:
  explicit SmallCholesky(const Matrix& matrix);
  [[nodiscard]] bool positive_definite() const { return factor_.info() == Eigen::Success; }
  [[nodiscard]] Matrix lower() const;
  [[nodiscard]] Matrix solve(const Matrix& right) const;
  /// Returns L⁻¹ B.
  [[nodiscard]] Matrix solve_lower(const Matrix& right) const;

 private:
  Eigen::LLT<Matrix> factor_;
};

/// LU factorization P A = L U of a square matrix. For a singular matrix, results are not finite or meaningless.
class PivotedLu {
 public:
  explicit PivotedLu(const Matrix& matrix);
  [[nodiscard]] Vector solve(const Vector& right) const;
  [[nodiscard]] Matrix inverse() const;

 private:
  Eigen::PartialPivLU<Matrix> factor_;
};

/// Factorization P A Pᵀ = L D Lᵀ, A symmetric and semi-definite. Reads the lower triangle.
class PivotedCholesky {
 public:
  explicit PivotedCholesky(const Matrix& matrix);
  [[nodiscard]] Vector solve(const Vector& right) const;
  [[nodiscard]] Matrix solve(const Matrix& right) const;
  /// Returns the diagonal of D.
  [[nodiscard]] Vector pivots() const;
  /// Returns P v.
  [[nodiscard]] Vector permuted(const Vector& values) const;

 private:
  Eigen::LDLT<Matrix> factor_;
};

/// QR factorization A P = Q R with decreasing pivots. The rank counts the pivots above `threshold` times the largest;
/// zero selects a threshold of the size of rounding errors.
class PivotedQr {
 public:
  explicit PivotedQr(const Matrix& matrix, double threshold = 0.0);
  [[nodiscard]] Index rank() const { return factor_.rank(); }
  /// Returns a least-squares solution.
  [[nodiscard]] Vector solve(const Vector& right) const;
  [[nodiscard]] Matrix solve(const Matrix& right) const;

 private:
  Eigen::ColPivHouseholderQR<Matrix> factor_;
};

/// Least-squares solution of minimum norm, A of any rank; `threshold` as in PivotedQr.
template <class AnyMatrix>
class AnyLeastNormSolver {
 public:
  using AnyVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, AnyMatrix::MaxRowsAtCompileTime, 1>;

  explicit AnyLeastNormSolver(const AnyMatrix& matrix, double threshold = 0.0);
  [[nodiscard]] Index rank() const { return factor_.rank(); }
  [[nodiscard]] AnyVector solve(const AnyVector& right) const;

 private:
  Eigen::CompleteOrthogonalDecomposition<AnyMatrix> factor_;
};
using LeastNormSolver = AnyLeastNormSolver<Matrix>;
/// At most six equations and unknowns, without memory from the heap.
using SixMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using SixVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using SixLeastNormSolver = AnyLeastNormSolver<SixMatrix>;
extern template class AnyLeastNormSolver<Matrix>;
extern template class AnyLeastNormSolver<SixMatrix>;

/// Returns R of A = Q R, square; A has at least as many rows as columns.
[[nodiscard]] Matrix upper_of_qr(const Matrix& matrix);

/// Eigenvalues, ascending, and unit eigenvectors of a symmetric matrix, whose lower triangle is read.
struct SymmetricEigen {
  Vector values;
  Matrix vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Matrix& matrix);
/// Returns the eigenvalues alone.
[[nodiscard]] Vector symmetric_eigenvalues(const Matrix& matrix);
[[nodiscard]] Eigen::Vector2d symmetric_eigenvalues(const Eigen::Matrix2d& matrix);
[[nodiscard]] Eigen::Vector3d symmetric_eigenvalues(const Eigen::Matrix3d& matrix);
/// Returns the eigenvalues of a tridiagonal matrix, or none if the iteration does not converge (entries that are not
/// finite).
[[nodiscard]] std::optional<Vector> tridiagonal_eigenvalues(const Vector& diagonal, const Vector& beside);

}  // namespace ricochet
