#include "ricochet/base/dense_decompositions.hpp"

#include <gtest/gtest.h>

#include <cmath>

/// @file Guarantees of the dense decompositions.
namespace ricochet {
namespace {

double largest(const Matrix& matrix) { return matrix.cwiseAbs().maxCoeff(); }

const Matrix spd = (Matrix(3, 3) << 4.0, 1.0, 0.5, 1.0, 3.0, -0.2, 0.5, -0.2, 2.0).finished();
const Matrix right = (Matrix(3, 2) << 1.0, 0.0, -2.0, 1.0, 0.5, 3.0).finished();

TEST(DenseDecompositions, OfDefiniteMatrices) {
  const SmallCholesky cholesky(spd);
  ASSERT_TRUE(cholesky.positive_definite());
  EXPECT_LE(largest(cholesky.lower() * cholesky.lower().transpose() - spd), 1e-15);
  EXPECT_LE(largest(spd * cholesky.solve(right) - right), 1e-14);
  EXPECT_LE(largest(cholesky.lower() * cholesky.solve_lower(right) - right), 1e-15);
  EXPECT_FALSE(SmallCholesky(-spd).positive_definite());
  const PivotedCholesky pivoted(spd);
  EXPECT_LE(largest(spd * pivoted.solve(right) - right), 1e-14);
  EXPECT_LE(largest(spd * pivoted.solve(Vector(right.col(0))) - right.col(0)), 1e-14);
  EXPECT_NEAR(pivoted.pivots().prod(), cholesky.lower().diagonal().prod() * cholesky.lower().diagonal().prod(), 1e-13);
  EXPECT_EQ(pivoted.permuted(spd.diagonal())[0], 4.0) << "the largest comes first";
}

TEST(DenseDecompositions, OfMatricesOfAnyRank) {
  Matrix flat(3, 2);
  flat << 1.0, 2.0, 2.0, 4.0, 3.0, 6.0 + 1e-8;
  EXPECT_EQ(PivotedQr(flat).rank(), 2);
  EXPECT_EQ(PivotedQr(flat, 1e-6).rank(), 1);
  const Vector least = LeastNormSolver(flat, 1e-6).solve(Vector(flat.col(0)));
  // Solution of x + 2y = 1 of least length.
  EXPECT_NEAR(least[0], 0.2, 1e-7);
  EXPECT_NEAR(least[1], 0.4, 1e-7);
  const Matrix upper = upper_of_qr(flat);
  EXPECT_LE(largest(upper.transpose() * upper - flat.transpose() * flat), 1e-13);
  EXPECT_EQ(upper(1, 0), 0.0);
}

TEST(DenseDecompositions, OfSymmetricMatrices) {
  const SymmetricEigen eigen = symmetric_eigen(spd);
  EXPECT_LE(largest(spd * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()), 1e-14);
  EXPECT_LE((symmetric_eigenvalues(spd) - eigen.values).cwiseAbs().maxCoeff(), 1e-14);
  const Eigen::Matrix3d fixed = spd;
  EXPECT_LE((symmetric_eigenvalues(fixed) - eigen.values).cwiseAbs().maxCoeff(), 1e-14);
  // −u″ on a line: 2 − 2 cos(kπ/(n+1)).
  const auto values = tridiagonal_eigenvalues(Vector::Constant(5, 2.0), Vector::Constant(4, -1.0));
  ASSERT_TRUE(values);
  for (Index k = 0; k < 5; ++k) EXPECT_NEAR((*values)[k], 2.0 - 2.0 * std::cos(double(k + 1) * M_PI / 6.0), 1e-14);
  EXPECT_FALSE(tridiagonal_eigenvalues(Vector::Constant(5, NAN), Vector::Constant(4, NAN)));
}

}  // namespace
}  // namespace ricochet
