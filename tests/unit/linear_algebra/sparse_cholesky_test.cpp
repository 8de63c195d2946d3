#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "support/grid_matrix.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace ricochet::test_support {
namespace {

/// A sparse symmetric positive definite matrix: the Laplacian of a weighted graph (a ring and random chords) plus a
/// small diagonal, badly scaled on request.
SparseMatrix random_matrix(Index size, unsigned seed, double spread = 1.0) {
  std::mt19937 random(seed);
  Matrix dense = Matrix::Zero(size, size);
  for (Index i = 0; i < size; ++i) {
    for (const Index j : {(i + 1) % size, Index(random() % unsigned(size))}) {
      if (i == j) continue;
      const double weight = std::pow(spread, uniform(random));
      dense(i, j) -= weight;
      dense(j, i) = dense(i, j);
      dense(i, i) += weight;
      dense(j, j) += weight;
    }
    dense(i, i) += 0.1;
  }
  return dense.sparseView();
}

using Arithmetic = SparseCholesky::Arithmetic;

TEST(SparseCholesky, SolvesAsEigenDoes) {
  for (const Index size : {1, 2, 3, 10, 57, 200}) {
    const SparseMatrix matrix = random_matrix(size, 5);
    const Vector right = random_vector(size, 6);
    const Vector expected = Matrix(matrix).llt().solve(right);
    for (const Arithmetic solve : {Arithmetic::own, Arithmetic::library}) {
      SparseCholesky factor(matrix, solve);
      ASSERT_TRUE(factor.positive_definite());
      EXPECT_EQ(factor.size(), size);
      EXPECT_EQ(factor.failed_unknown(), -1);
      EXPECT_GE(factor.factor_entries(), std::size_t(size));
      EXPECT_GE(factor.factor_bytes(), std::size_t(size) * sizeof(double));
      Vector x;
      factor.solve(right, x);
      EXPECT_LE((x - expected).norm(), 1e-13 * expected.norm()) << size;
      factor.solve(2.0 * right, x);
      EXPECT_LE((x - 2.0 * expected).norm(), 1e-13 * expected.norm()) << "the second solve";
    }
  }
}

TEST(SparseCholesky, PredictsWhatTheFactorizationTakes) {
  const SparseMatrix matrix = random_matrix(300, 7);
  SparseCholesky factor;
  factor.analyse(matrix);
  const auto predicted = factor.predicted();
  EXPECT_GT(predicted.operations, 300.0);
  factor.factorize();
  EXPECT_EQ(predicted.entries, double(factor.factor_entries()));
  Vector x;
  factor.solve(matrix * Vector::Ones(300), x);
  EXPECT_LE((x - Vector::Ones(300)).norm(), 1e-12);
}

TEST(SparseCholesky, KnowsThePlaceOfEveryUnknown) {
  const SparseCholesky factor(random_matrix(40, 8));
  for (Index place = 0; place < 40; ++place)
    EXPECT_EQ(factor.factor_index(factor.permutation()[std::size_t(place)]), place);
}

/// Adding L⁻¹P f between the two solves has the effect of the force f.
TEST(SparseCholesky, ForcesMayEnterBetweenTheTwoSolves) {
  const Index size = 60;
  const SparseMatrix matrix = random_matrix(size, 21);
  SparseCholesky factor(matrix);
  const Vector right = random_vector(size, 22), force = random_vector(size, 23);
  Vector y, z, x, expected;
  factor.forward(right, y);
  factor.forward(force, z);
  factor.backward(y + z, x);
  factor.solve(right + force, expected);
  EXPECT_LE((x - expected).norm(), 1e-13 * expected.norm());
}

TEST(SparseCholesky, PowersOfTwoChangeNoBit) {
  const Index size = 120;
  const SparseMatrix matrix = random_matrix(size, 31, 1e3);
  const Vector right = random_vector(size, 32);
  for (const Arithmetic solve : {Arithmetic::own, Arithmetic::library}) {
    SparseCholesky one(matrix, solve);
    Vector expected;
    one.solve(right, expected);
    for (const int power : {-301, -37, -2, -1, 1, 2, 3, 20, 41, 300}) {
      SparseCholesky scaled(matrix * std::ldexp(1.0, power), solve);
      Vector x;
      scaled.solve(right * std::ldexp(1.0, power + 5), x);
      EXPECT_TRUE(x == expected * 32.0) << power;
    }
  }
}

TEST(SparseCholesky, SeesThatAMatrixIsNotPositiveDefinite) {
  const Index size = 30;
  for (const Index unknown : {Index{0}, Index{13}, size - 1}) {
    SparseMatrix negative = random_matrix(size, 41);
    negative.coeffRef(unknown, unknown) = -1.0;
    EXPECT_FALSE(SparseCholesky(negative).positive_definite()) << unknown;
    EXPECT_GE(SparseCholesky(negative).failed_unknown(), 0);
  }
}

TEST(SparseCholesky, NamesTheUnknownAtWhichItStops) {
  // A diagonal matrix, so that only one pivot can fail.
  for (const Index unknown : {Index{0}, Index{4}, Index{9}}) {
    for (const double bad : {0.0, -3.0}) {
      SparseMatrix diagonal(10, 10);
      for (Index i = 0; i < 10; ++i) diagonal.insert(i, i) = i == unknown ? bad : 1.0 + double(i);
      diagonal.makeCompressed();
      const SparseCholesky factor(diagonal);
      EXPECT_FALSE(factor.positive_definite()) << unknown << " " << bad;
      EXPECT_EQ(factor.failed_unknown(), unknown);
    }
  }
}

TEST(SparseCholesky, OfNothingIsNothing) {
  SparseCholesky factor((SparseMatrix(0, 0)));
  EXPECT_TRUE(factor.positive_definite());
  EXPECT_EQ(factor.size(), 0);
  Vector x = Vector::Ones(3);
  factor.solve(Vector(), x);
  EXPECT_EQ(x.size(), 0);
}

TEST(SparseCholesky, MayBeMoved) {
  const SparseMatrix matrix = random_matrix(20, 51);
  SparseCholesky first(matrix);
  SparseCholesky second(std::move(first));
  Vector x;
  second.solve(matrix * Vector::Ones(20), x);
  EXPECT_LE((x - Vector::Ones(20)).norm(), 1e-12);
}

}  // namespace
}  // namespace ricochet::test_support
