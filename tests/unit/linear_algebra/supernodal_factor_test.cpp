#include "ricochet/linear_algebra/supernodal_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/linear_algebra/supernodal_kernels.hpp"

namespace ricochet {
namespace {

double uniform_entry(std::mt19937& random) {
  return static_cast<double>(random()) / 2147483648.0 - 1.0;
}

Vector random_right_side(Index size, unsigned seed) {
  std::mt19937 random(seed);
  Vector result(size);
  for (double& value : result) value = uniform_entry(random);
  return result;
}

/// Two unknowns per node of a square grid, coupled with their neighbours: what a plane body's matrix looks like.
SparseMatrix grid_matrix(int side, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&](int a, int b) {
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        const double value = uniform_entry(random);
        entries.emplace_back(2 * a + i, 2 * b + j, value);
        entries.emplace_back(2 * b + j, 2 * a + i, value);
        entries.emplace_back(2 * a + i, 2 * a + i, std::abs(value) + 0.02);
        entries.emplace_back(2 * b + j, 2 * b + j, std::abs(value) + 0.02);
      }
    }
  };
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int node = x + side * y;
      if (x + 1 < side) couple(node, node + 1);
      if (y + 1 < side) couple(node, node + side);
      if (x + 1 < side && y + 1 < side) couple(node, node + side + 1);
    }
  }
  SparseMatrix matrix(2 * side * side, 2 * side * side);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// A lower triangular supernode of every shape near the widths of blocks and panels, against plain loops.
TEST(SupernodalKernels, SolveWithEveryShape) {
  for (Index columns = 1; columns <= 19; ++columns) {
    for (Index below = 0; below <= 19; ++below) {
      const Index rows = columns + below;
      std::mt19937 random(static_cast<unsigned>(31 * columns + below));
      Matrix factor = Matrix::NullaryExpr(rows, columns, [&] { return uniform_entry(random); });
      for (Index j = 0; j < columns; ++j) {
        factor(j, j) = 2.0 + std::abs(factor(j, j));
        for (Index i = 0; i < j; ++i) factor(i, j) = std::nan("");  // not to be read
      }
      const Matrix triangle = factor.topRows(columns).triangularView<Eigen::Lower>();
      const Matrix beneath = factor.bottomRows(below);
      std::vector<double> stream(static_cast<std::size_t>(supernode_stream_size(columns, rows)));
      ASSERT_EQ(write_supernode(factor.data(), columns, rows, stream.data()), stream.data() + stream.size());

      const Vector right = random_right_side(rows, 5);
      Vector expected = right, found(rows + 1);
      triangle.triangularView<Eigen::Lower>().solveInPlace(expected.head(columns));
      expected.tail(below) -= beneath * expected.head(columns);
      found << right, 0.0;
      EXPECT_EQ(supernode_forward(stream.data(), columns, rows, found.data()), stream.data() + stream.size());
      EXPECT_LE((found.head(rows) - expected).cwiseAbs().maxCoeff(), 1e-14) << columns << " " << below;

      Matrix eight = Matrix::Zero(8, rows + 1);
      eight.row(3).head(rows) = right.transpose();
      eight.row(6).head(rows) = -4.0 * right.transpose();
      supernode_forward_eight(stream.data(), columns, rows, eight.data());
      EXPECT_TRUE(eight.row(6).head(rows) == -4.0 * eight.row(3).head(rows));
      EXPECT_TRUE(eight.row(0).head(rows).isZero(0.0));
      EXPECT_LE((eight.row(3).head(rows).transpose() - expected).cwiseAbs().maxCoeff(), 1e-14);

      expected = right;
      expected.head(columns) -= beneath.transpose() * expected.tail(below);
      triangle.transpose().triangularView<Eigen::Upper>().solveInPlace(expected.head(columns));
      found << right, 0.0;
      EXPECT_EQ(supernode_backward(stream.data() + stream.size(), columns, rows, found.data()), stream.data());
      EXPECT_LE((found.head(rows) - expected).cwiseAbs().maxCoeff(), 1e-14) << columns << " " << below;
    }
  }
}

/// Large enough to be divided into subtrees.
class LargeFactor : public testing::Test {
 protected:
  ~LargeFactor() override { set_thread_count(1); }
  SparseMatrix matrix_ = grid_matrix(110);
  SparseCholesky own_{matrix_};
  Index size_ = matrix_.cols();
};

TEST_F(LargeFactor, SolvesAsTheLibraryDoes) {
  SparseCholesky library(matrix_, SparseCholesky::TriangularSolve::library);
  const Vector right = random_right_side(size_, 3);
  EXPECT_GT(own_.work_size(), size_) << "not divided: nothing to test";
  EXPECT_LT(own_.factor_bytes(), 1.1 * static_cast<double>(library.factor_bytes()));
  Vector y, z, x, expected;
  own_.forward(right, y);
  library.forward(right, z);
  EXPECT_LE((y.head(size_) - z).norm(), 1e-13 * z.norm());
  own_.solve(right, x);
  library.solve(right, expected);
  EXPECT_LE((x - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LE((matrix_ * x - right).norm(), 1e-12 * right.norm());
}

TEST_F(LargeFactor, GivesTheSameBitsForAnyNumberOfThreads) {
  const Vector right = random_right_side(size_, 4);
  Vector expected, x;
  own_.solve(right, expected);
  for (const int threads : {2, 3, 7}) {
    set_thread_count(threads);
    own_.solve(right, x);
    EXPECT_TRUE(x == expected) << threads;
  }
}

/// Columns of L⁻¹P Hᵀ on their paths: (L⁻¹P hᵀ)·(L⁻¹P b) = h (2ᵏA)⁻¹ b for any sparse h.
TEST_F(LargeFactor, SolvesSparseColumnsOnTheirPaths) {
  const SupernodalFactor& factor = own_.supernodal();
  const std::vector<std::vector<Index>> places{{0}, {7, 8}, {size_ - 1}, {100, 15000}, {size_ / 2, 3}};
  Vector y;
  own_.forward(random_right_side(size_, 5), y);
  for (const auto& at : places) {
    const FactorPath path = factor.path(at);
    Matrix column = Matrix::Zero(path.rows(), 1);
    Vector whole = Vector::Zero(own_.work_size());
    for (const Index place : at) {
      const auto k =
          static_cast<std::size_t>(std::upper_bound(path.first.begin(), path.first.end(), place) - path.first.begin()) -
          1;
      column(path.offsets[k] + place - path.first[k], 0) = 1.0 + static_cast<double>(place % 3);
      whole[place] = 1.0 + static_cast<double>(place % 3);
    }
    factor.forward_on_path(path, column);
    own_.solve_lower(whole);
    double size = 0.0;
    for (std::size_t k = 0; k < path.supernodes.size(); ++k) {
      const Index count = path.offsets[k + 1] - path.offsets[k];
      EXPECT_LE((column.col(0).segment(path.offsets[k], count) - whole.segment(path.first[k], count)).norm(), 1e-14);
      size += whole.segment(path.first[k], count).squaredNorm();
    }
    EXPECT_NEAR(size, whole.head(size_).squaredNorm(), 1e-12 * size) << "something lies outside the path";
  }
}

TEST_F(LargeFactor, GivesColumnsTheSameBitsInAnyCompany) {
  const SupernodalFactor& factor = own_.supernodal();
  const std::vector<Index> places{5, 900, 901, 4000, 9000, 12345, 20000, 20001, 24000, 24100};
  const auto solve = [&](const std::vector<Index>& chosen, Index wanted) {
    const FactorPath path = factor.path(chosen);
    Matrix columns = Matrix::Zero(path.rows(), static_cast<Index>(chosen.size()));
    const auto on_path = [&](Index place) {
      const auto k =
          static_cast<std::size_t>(std::upper_bound(path.first.begin(), path.first.end(), place) - path.first.begin()) -
          1;
      return path.offsets[k] + place - path.first[k];
    };
    Index at = 0;
    for (std::size_t j = 0; j < chosen.size(); ++j) {
      columns(on_path(chosen[j]), static_cast<Index>(j)) = 1.0;
      if (chosen[j] == wanted) at = static_cast<Index>(j);
    }
    factor.forward_on_path(path, columns);
    Vector whole = Vector::Zero(size_);
    for (std::size_t k = 0; k < path.supernodes.size(); ++k) {
      const Index count = path.offsets[k + 1] - path.offsets[k];
      whole.segment(path.first[k], count) = columns.col(at).segment(path.offsets[k], count);
    }
    return whole;
  };
  for (const Index wanted : places) EXPECT_TRUE(solve(places, wanted) == solve({wanted}, wanted)) << wanted;
}

}  // namespace
}  // namespace ricochet
