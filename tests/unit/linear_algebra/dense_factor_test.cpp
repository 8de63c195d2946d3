#include "ricochet/linear_algebra/dense_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace ricochet {
namespace {

Matrix random_dense_matrix(Index rows, Index columns, unsigned seed) {
  std::mt19937 random(seed);
  return Matrix::NullaryExpr(rows, columns, [&] { return double(random()) / 2147483648.0 - 1.0; });
}

TEST(DenseFactor, MultipliesPartsOfMatrices) {
  const Matrix left = random_dense_matrix(40, 9, 1), right = random_dense_matrix(30, 8, 2),
               start = random_dense_matrix(12, 12, 3);
  Matrix found = start, expected = start;
  add_transposed_product(20, 5, 6, &left(10, 2), left.rows(), &right(4, 1), right.rows(), &found(3, 2), found.rows());
  expected.block(3, 2, 5, 6) += left.block(10, 2, 20, 5).transpose() * right.block(4, 1, 20, 6);
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(DenseFactor, MultipliesByTheTranspose) {
  const Matrix matrix = random_dense_matrix(40, 9, 1);
  const Vector x = random_dense_matrix(40, 1, 2);
  Vector y(9);
  multiply_transposed(matrix, x, y.data());
  EXPECT_LE((y - matrix.transpose() * x).cwiseAbs().maxCoeff(), 1e-14);
  multiply_transposed(Matrix(0, 9), Vector(), y.data());
  EXPECT_TRUE(y.isZero(0.0));
}

TEST(DenseFactor, LuSolvesAndShowsSingularity) {
  DenseLu factor;
  Vector x;
  for (const Index size : {1, 6, 150}) {
    const Matrix matrix = random_dense_matrix(size, size, 4);
    const Vector right = random_dense_matrix(size, 1, 5);
    factor.compute(matrix);
    factor.solve(right, x);
    EXPECT_LE((matrix * x - right).cwiseAbs().maxCoeff(), 1e-11) << size;
    EXPECT_GT(factor.smallest_pivot(), 1e-8);
  }
  Matrix singular = Matrix::Ones(3, 3);
  factor.compute(singular);
  EXPECT_EQ(factor.smallest_pivot(), 0.0);
  factor.solve(Vector::Ones(3), x);
  EXPECT_FALSE(x.allFinite());
}

TEST(DenseFactor, PowersOfTwoScaleTheResultExactly) {
  const Matrix matrix = random_dense_matrix(90, 90, 6);
  const Vector right = random_dense_matrix(90, 1, 7);
  DenseLu factor;
  Vector a, b;
  factor.compute(matrix);
  factor.solve(right, a);
  factor.compute(std::ldexp(1.0, 31) * matrix);
  factor.solve(std::ldexp(1.0, -17) * right, b);
  EXPECT_TRUE(b == std::ldexp(1.0, -48) * a);
}

}  // namespace
}  // namespace ricochet
