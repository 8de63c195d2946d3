#include "ricochet/base/dense_decompositions.hpp"

#include <Eigen/Eigenvalues>

namespace ricochet {

SmallCholesky::SmallCholesky(const Matrix& matrix) : factor_(matrix) {}

Matrix SmallCholesky::lower() const { return factor_.matrixL(); }

Matrix SmallCholesky::solve(const Matrix& right) const { return factor_.solve(right); }

Matrix SmallCholesky::solve_lower(const Matrix& right) const { return factor_.matrixL().solve(right); }

PivotedLu::PivotedLu(const Matrix& matrix) : factor_(matrix) {}

Vector PivotedLu::solve(const Vector& right) const { return factor_.solve(right); }

Matrix PivotedLu::inverse() const { return factor_.inverse(); }

PivotedCholesky::PivotedCholesky(const Matrix& matrix) : factor_(matrix) {}

Vector PivotedCholesky::solve(const Vector& right) const { return factor_.solve(right); }

Matrix PivotedCholesky::solve(const Matrix& right) const { return factor_.solve(right); }

Vector PivotedCholesky::pivots() const { return factor_.vectorD(); }

Vector PivotedCholesky::permuted(const Vector& values) const { return factor_.transpositionsP() * values; }

PivotedQr::PivotedQr(const Matrix& matrix, double threshold) : factor_(matrix.rows(), matrix.cols()) {
  if (threshold > 0.0) factor_.setThreshold(threshold);
  factor_.compute(matrix);
}

Vector PivotedQr::solve(const Vector& right) const { return factor_.solve(right); }

Matrix PivotedQr::solve(const Matrix& right) const { return factor_.solve(right); }

template <class AnyMatrix>
AnyLeastNormSolver<AnyMatrix>::AnyLeastNormSolver(const AnyMatrix& matrix, double threshold)
    : factor_(matrix.rows(), matrix.cols()) {
  if (threshold > 0.0) factor_.setThreshold(threshold);
  factor_.compute(matrix);
}

template <class AnyMatrix>
auto AnyLeastNormSolver<AnyMatrix>::solve(const AnyVector& right) const -> AnyVector {
  return factor_.solve(right);
}

template class AnyLeastNormSolver<Matrix>;
template class AnyLeastNormSolver<SixMatrix>;

Matrix upper_of_qr(const Matrix& matrix) {
  return Eigen::HouseholderQR<Matrix>(matrix).matrixQR().topRows(matrix.cols()).triangularView<Eigen::Upper>();
}

SymmetricEigen symmetric_eigen(const Matrix& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Vector symmetric_eigenvalues(const Matrix& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

// Eigen's closed forms are avoided: they lose half of the digits if two eigenvalues coincide.
Eigen::Vector2d symmetric_eigenvalues(const Eigen::Matrix2d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::Vector3d symmetric_eigenvalues(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

std::optional<Vector> tridiagonal_eigenvalues(const Vector& diagonal, const Vector& beside) {
  Eigen::SelfAdjointEigenSolver<Matrix> solver;
  solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

}  // namespace ricochet
