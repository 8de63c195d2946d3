#include "ricochet/linear_algebra/dense_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace ricochet {
namespace {

Matrix random_matrix(Index rows, Index columns, unsigned seed) {
  std::mt19937 random(seed);
  return Matrix::NullaryExpr(rows, columns, [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; });
}

TEST(DenseFactor, SolvesTriangularSystems) {
  for (const Index size : {1, 7, 130}) {
    Matrix factor = random_matrix(size, size, 1);
    factor.diagonal().array() += 0.6 * static_cast<double>(size);
    const Matrix right = random_matrix(size, 5, 2);
    Matrix found = right;
    solve_lower_triangular(factor, found);  // what is above the diagonal must not matter
    const Matrix lower = factor.triangularView<Eigen::Lower>();
    EXPECT_LE((lower * found - right).cwiseAbs().maxCoeff(), 1e-13) << size;
  }
  Matrix nothing(3, 0);
  solve_lower_triangular(Matrix::Identity(3, 3), nothing);
}

TEST(DenseFactor, GramMatrixIsSymmetricToTheBit) {
  const Matrix columns = random_matrix(40, 33, 3);
  const Matrix gram = gram_matrix(columns);
  EXPECT_LE((gram - columns.transpose() * columns).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_TRUE(gram == gram.transpose());
  EXPECT_EQ(gram_matrix(Matrix(0, 4)), Matrix::Zero(4, 4));
}

TEST(DenseFactor, LuSolvesAndShowsSingularity) {
  DenseLu factor;
  Vector x;
  for (const Index size : {1, 6, 150}) {
    const Matrix matrix = random_matrix(size, size, 4);
    const Vector right = random_matrix(size, 1, 5);
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
  const Matrix matrix = random_matrix(90, 90, 6);
  const Vector right = random_matrix(90, 1, 7);
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
