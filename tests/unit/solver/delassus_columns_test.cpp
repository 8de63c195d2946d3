#include "ricochet/solver/delassus/delassus_columns.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "support/uniform.hpp"

namespace ricochet::test_support {
namespace {

/// A chain of `size` unknowns with some long links, positive definite.
SparseMatrix chain(Index size) {
  std::mt19937 random(11);
  Matrix dense = Matrix::Zero(size, size);
  for (Index i = 0; i + 1 < size; ++i) {
    for (const Index j : {i + 1, std::min(size - 1, i + 10)}) {
      const double weight = 0.5 + 0.4 * uniform(random);
      dense(i, j) -= weight;
      dense(j, i) = dense(i, j);
      dense(i, i) += weight;
      dense(j, j) += weight;
    }
  }
  dense.diagonal().array() += 0.1;
  return dense.sparseView();
}

/// Rows of H: one or two unknowns each.
SparseMatrix rows_of_h(Index size, Index count, unsigned seed) {
  std::mt19937 random(seed);
  SparseMatrix transposed(size, count);
  for (Index row = 0; row < count; ++row) {
    const auto unknown = Index(random() % unsigned(size - 1));
    transposed.insert(unknown, row) = uniform(random);
    if (row % 3 == 0) transposed.insert(unknown + 1, row) = uniform(random);
  }
  transposed.makeCompressed();
  return transposed;
}

class ContactColumnsTest : public testing::Test {
 protected:
  static constexpr Index size = 150;
  SparseMatrix matrix_ = chain(size);
  SparseCholesky factor_{matrix_};
  Matrix inverse_ = Matrix(factor_.scale() * matrix_).llt().solve(Matrix::Identity(size, size));
};

TEST_F(ContactColumnsTest, GiveTheCondensedOperator) {
  DelassusColumns columns(factor_);
  Matrix w, h(0, size);
  // Added in groups of several sizes, with and without a full block.
  for (const Index count : {5, 1, 60, 24}) {
    const SparseMatrix transposed = rows_of_h(size, count, unsigned(count));
    const Matrix before = w;
    columns.append(transposed, w);
    const Index rows = h.rows();
    h.conservativeResize(rows + count, Eigen::NoChange);
    h.bottomRows(count) = Matrix(transposed).transpose();
    EXPECT_EQ(columns.rows(), h.rows());
    EXPECT_TRUE(w.topLeftCorner(rows, rows) == before) << "what was there keeps its bits";
  }
  const Matrix expected = h * inverse_ * h.transpose();
  EXPECT_LE((w - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
  EXPECT_TRUE(w == w.transpose());
  EXPECT_LE(columns.entries(), std::size_t(size * h.rows()));
}

TEST_F(ContactColumnsTest, GiveMotionsAndTakeReactions) {
  DelassusColumns columns(factor_);
  Matrix w;
  const SparseMatrix transposed = rows_of_h(size, 70, 5);
  columns.append(transposed, w);
  std::mt19937 random(6);
  const Vector right = Vector::NullaryExpr(size, [&] { return uniform(random); });
  Vector reaction = Vector::NullaryExpr(70, [&] { return uniform(random); });
  for (Index i = 0; i < 70; i += 2) reaction[i] = 0.0;
  Vector y, motion, x;
  factor_.forward(right, y);
  columns.motion(y, motion);
  const Vector free = inverse_ * (factor_.scale() * right);
  EXPECT_LE((motion - transposed.transpose() * free).norm(), 1e-12 * motion.norm());
  columns.add_reaction(reaction, y);
  factor_.backward(y, x);
  const Vector moved = free + inverse_ * (transposed * reaction);
  EXPECT_LE((x - moved).norm(), 1e-12 * moved.norm());
}

TEST_F(ContactColumnsTest, OfRowsWithoutUnknownsAreNothing) {
  DelassusColumns columns(factor_);
  Matrix w;
  columns.append(SparseMatrix(size, 3), w);
  EXPECT_EQ(w, Matrix::Zero(3, 3));
  Vector y, motion;
  factor_.forward(Vector::Ones(size), y);
  const Vector before = y;
  columns.motion(y, motion);
  EXPECT_TRUE(motion == Vector::Zero(3));
  columns.add_reaction(Vector::Ones(3), y);
  EXPECT_TRUE(y == before);
  columns.clear();
  EXPECT_EQ(columns.rows(), 0);
}

}  // namespace
}  // namespace ricochet::test_support
