#include "ricochet/linear_algebra/gmres.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "ricochet/linear_algebra/dense_factor.hpp"
#include "support/contact_problems.hpp"

namespace ricochet::test_support {
namespace {

Matrix near_identity(Index size, std::mt19937& random) {
  Matrix matrix = Matrix::Identity(size, size);
  for (double& value : matrix.reshaped()) value += 0.3 * uniform(random);
  return matrix;
}

/// The preconditioner is exact except for k columns: k + 1 iterations are enough.
TEST(Gmres, NeedsAsManyIterationsAsThereAreDifferences) {
  std::mt19937 random(4);
  const Index size = 60;
  const Matrix earlier = near_identity(size, random);
  Matrix matrix = earlier;
  for (const Index column : {3, 17, 40}) matrix.col(column) = near_identity(size, random).col(column);
  const Eigen::PartialPivLU<Matrix> factor(earlier);
  const Vector right = uniform(size, random);
  Gmres gmres;
  Vector x;
  const double reached = gmres.solve([&](const Vector& v, Vector& w) { multiply_dense(matrix, v, w); },
                                     [&](const Vector& v, Vector& w) { w = factor.solve(v); }, right, 1e-12, 10, x);
  EXPECT_LE(reached, 1e-12);
  EXPECT_LE(gmres.iterations(), 4);
  EXPECT_LE((matrix * x - right).norm(), 1e-11 * right.norm());
}

/// The reported residual belongs to the returned solution.
TEST(Gmres, KnowsItsResidual) {
  std::mt19937 random(5);
  const Index size = 40;
  const Matrix matrix = near_identity(size, random);
  const Vector right = uniform(size, random);
  Gmres gmres;
  Vector x;
  const auto multiply = [&](const Vector& v, Vector& w) { multiply_dense(matrix, v, w); };
  const auto nothing = [](const Vector& v, Vector& w) { w = v; };
  for (const Index limit : {1, 5, 20, 40}) {
    const double reached = gmres.solve(multiply, nothing, right, 1e-14, limit, x);
    EXPECT_NEAR((matrix * x - right).norm() / right.norm(), reached, 1e-12);
  }
  EXPECT_LE((matrix * x - right).norm(), 1e-12 * right.norm());
  EXPECT_EQ(gmres.solve(multiply, nothing, Vector::Zero(size), 1e-3, 5, x), 0.0);
  EXPECT_EQ(x, Vector::Zero(size));
}

/// Six digits, even where entries decay below the range of single precision, and without loss of speed.
TEST(SingleLu, SolvesToSixDigits) {
  std::mt19937 random(6);
  const Index size = 100;
  Matrix matrix = near_identity(size, random) + 20.0 * Matrix::Identity(size, size);
  for (Index j = 0; j < size; ++j) {
    for (Index i = 0; i < size; ++i) matrix(i, j) *= std::pow(10.0, -1.5 * double(std::abs(i - j)));
  }
  const Vector right = uniform(size, random);
  SingleLu factor;
  ASSERT_TRUE(factor.compute(matrix));
  Vector x;
  factor.solve(right, x);
  EXPECT_LE((x - matrix.lu().solve(right)).norm(), 1e-6 * x.norm());
  EXPECT_FALSE(factor.compute(Matrix::Zero(3, 3)));
}

}  // namespace
}  // namespace ricochet::test_support
