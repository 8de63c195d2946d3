#include "ricochet/linear_algebra/numeric_factorization.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>
#include <random>

#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "support/grid_matrix.hpp"

namespace ricochet::test_support {
namespace {

using Arithmetic = SparseCholesky::Arithmetic;

/// Expects the factor of CHOLMOD up to rounding.
void expect_factor(const SparseMatrix& matrix, const std::string& what) {
  SparseCholesky own(matrix), library(matrix, Arithmetic::library);
  ASSERT_TRUE(own.positive_definite()) << what;
  const Vector right = random_vector(matrix.cols(), 3);
  Vector y, z, x;
  own.forward(right, y);
  library.forward(right, z);
  EXPECT_LE((y.head(matrix.cols()) - z).norm(), 1e-13 * z.norm()) << what;
  own.solve(right, x);
  EXPECT_LE((matrix * x - right).norm(), 1e-13 * right.norm()) << what;
}

/// One supernode, of every width near the widths of blocks, heads and panels.
TEST(NumericFactorization, OfDenseMatricesOfEverySize) {
  std::mt19937 random(1);
  std::vector<Index> sizes;
  for (Index size = 1; size <= 40; ++size) sizes.push_back(size);
  for (const Index size : {121, 127, 128, 129, 135, 136, 137, 191, 256, 257, 263, 264, 300, 401}) sizes.push_back(size);
  for (const Index size : sizes) {
    Matrix root = Matrix::NullaryExpr(size, size, [&] { return uniform(random); });
    const Matrix dense = root * root.transpose() + Matrix::Identity(size, size);
    expect_factor(dense.sparseView(), std::to_string(size));
  }
}

/// Supernodes of many shapes, some in sequences that grids do not produce.
TEST(NumericFactorization, OfRandomPatterns) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const int size = 20 + int(random() % 400);
    const int couplings = int(random() % unsigned(3 * size));
    std::vector<Eigen::Triplet<double>> entries;
    Vector diagonal = Vector::Constant(size, 0.5);
    for (int k = 0; k < couplings; ++k) {
      // Cliques of nodes, as coupled by elements.
      const int width = 2 + int(random() % 6);
      std::vector<int> nodes;
      for (int i = 0; i < width; ++i) nodes.push_back(int(random() % unsigned(size)));
      for (const int a : nodes) {
        for (const int b : nodes) {
          if (a == b) continue;
          entries.emplace_back(a, b, 0.1);
          entries.emplace_back(b, a, 0.1);
          diagonal[a] += 0.2;
        }
      }
    }
    for (int i = 0; i < size; ++i) entries.emplace_back(i, i, diagonal[i]);
    SparseMatrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    expect_factor(matrix, "seed " + std::to_string(seed));
  }
}

/// A matrix large enough for subtrees as tasks, divided panels above them, and supernodes of several panels.
class DividedFactorization : public testing::Test {
 protected:
  ~DividedFactorization() override { set_thread_count(1); }
  SparseMatrix matrix_ = grid_matrix(3, 15, 3, 7);
  Vector right_ = random_vector(matrix_.cols(), 8);
};

TEST_F(DividedFactorization, IsTheLibrarys) {
  expect_factor(matrix_, "in space");
  expect_factor(grid_matrix(2, 90, 2, 9), "in the plane");
}

TEST_F(DividedFactorization, GivesTheSameBitsForAnyNumberOfThreads) {
  SparseCholesky one(matrix_);
  EXPECT_GT(one.predicted().operations, 1e8) << "not divided: nothing to test";
  Vector expected, x;
  one.solve(right_, expected);
  for (const int threads : {2, 3, 7}) {
    set_thread_count(threads);
    SparseCholesky several(matrix_);
    several.solve(right_, x);
    EXPECT_TRUE(x == expected) << threads;
  }
}

TEST_F(DividedFactorization, IsMadeAgainWithTheBitsOfANewOne) {
  SparseMatrix other = matrix_;
  for (Index j = 0; j < other.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(other, j); entry; ++entry)
      entry.valueRef() *= entry.row() == j ? 1.25 : 0.75;
  }
  SparseCholesky fresh(other), again(matrix_);
  Vector expected, x;
  fresh.solve(right_, expected);
  SparseMatrix indefinite = other;
  indefinite.coeffRef(other.cols() / 2, other.cols() / 2) = -1e9;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    for (int round = 0; round < 2; ++round) {
      again.refactorize(round == 0 ? matrix_ : indefinite);
      EXPECT_EQ(again.positive_definite(), round == 0);
      again.refactorize(other);
      EXPECT_TRUE(again.positive_definite());
      again.solve(right_, x);
      EXPECT_TRUE(x == expected) << round << ", " << threads;
    }
  }
}

/// A misfit entry is detected in the triangle of a panel, below it, and in subtrees.
TEST_F(DividedFactorization, RefusesAMatrixOfAnotherPattern) {
  SparseCholesky factor(matrix_);
  Vector expected, x;
  factor.solve(right_, expected);
  const Index size = matrix_.cols();
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    for (const auto& [row, column] : {std::pair{size - 1, Index{0}}, std::pair{size / 2, Index{1}}}) {
      SparseMatrix other = matrix_;
      other.coeffRef(row, column) = other.coeffRef(column, row) = 1e-3;
      ASSERT_EQ(other.nonZeros(), matrix_.nonZeros() + 2);
      EXPECT_THROW(factor.refactorize(other), std::logic_error) << row << ", " << threads;
    }
    factor.refactorize(matrix_);
    factor.solve(right_, x);
    EXPECT_TRUE(x == expected) << threads;
  }
}

TEST_F(DividedFactorization, MayBeAnalysedAnew) {
  SparseCholesky factor(matrix_);
  factor.refactorize(matrix_);
  EXPECT_THROW(SparseCholesky(matrix_).factorize(), std::logic_error) << "what was analysed has been factorized";
  const SparseMatrix other = grid_matrix(2, 40, 2, 3);
  factor.analyse(other);
  factor.factorize();
  SparseCholesky fresh(other);
  const Vector right = random_vector(other.cols(), 8);
  Vector expected, x;
  fresh.solve(right, expected);
  factor.solve(right, x);
  EXPECT_TRUE(x == expected);
}

/// Whichever thread finds it first, the reported unknown is the one at which a single thread would stop.
TEST_F(DividedFactorization, StopsAtTheSameUnknownForAnyNumberOfThreads) {
  const SparseCholesky order(matrix_);
  const Index size = matrix_.cols();
  for (const Index place : {Index{17}, size / 2, size - 700, size - 1}) {
    const Index unknown = order.permutation()[std::size_t(place)];
    const Index later = order.permutation()[std::size_t(std::min(place + 500, size - 1))];
    for (const double bad : {-1e9, std::numeric_limits<double>::quiet_NaN()}) {
      SparseMatrix matrix = matrix_;
      matrix.coeffRef(unknown, unknown) = bad;
      matrix.coeffRef(later, later) = bad;
      for (const int threads : {1, 3}) {
        set_thread_count(threads);
        EXPECT_EQ(SparseCholesky(matrix).failed_unknown(), unknown) << place << " " << threads;
      }
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
