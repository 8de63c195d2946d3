#include "ricochet/linear_algebra/supernodal_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/linear_algebra/supernodal_kernels.hpp"
#include "ricochet/linear_algebra/supernode_layout.hpp"
#include "ricochet/linear_algebra/wide_supernode.hpp"
#include "support/grid_matrix.hpp"

namespace ricochet::test_support {
namespace {

/// Numbers of a supernode in the order of the layout.
std::vector<double> stream_of(const Matrix& factor) {
  const Index columns = factor.cols(), rows = factor.rows();
  std::vector<double> stream;
  for (Index first = 0, width = columns % 8; first < columns; first += width, width = 8) {
    if (width == 0) width = 8;
    Matrix inverse = Matrix::Zero(width <= 2 ? 2 : width <= 4 ? 4 : 8, width);
    inverse.topRows(width) = Matrix(factor.block(first, first, width, width))
                                 .triangularView<Eigen::Lower>()
                                 .solve(Matrix::Identity(width, width));
    stream.insert(stream.end(), inverse.reshaped().begin(), inverse.reshaped().end());
    for (Index row = first + width; row < rows;) {
      const Index left = (rows - row + 1) / 2 * 2, height = left >= 8 ? 8 : left >= 4 ? 4 : 2;
      for (Index j = first; j < first + width; ++j) {
        for (Index i = row; i < row + height; ++i) stream.push_back(i < rows ? factor(i, j) : 0.0);
      }
      row += height;
    }
  }
  return stream;
}

/// A lower triangular supernode of every shape near the widths of blocks and panels, compared with plain loops.
TEST(SupernodalKernels, SolveWithEveryShape) {
  for (Index columns = 1; columns <= 19; ++columns) {
    for (Index below = 0; below <= 19; ++below) {
      const Index rows = columns + below;
      std::mt19937 random(static_cast<unsigned>(31 * columns + below));
      Matrix factor = Matrix::NullaryExpr(rows, columns, [&] { return uniform(random); });
      for (Index j = 0; j < columns; ++j) {
        factor(j, j) = 2.0 + std::abs(factor(j, j));
        for (Index i = 0; i < j; ++i) factor(i, j) = std::nan("");  // not to be read
      }
      const Matrix triangle = factor.topRows(columns).triangularView<Eigen::Lower>();
      const Matrix beneath = factor.bottomRows(below);
      const std::vector<double> stream = stream_of(factor);
      ASSERT_EQ(SupernodeLayout(columns, rows).size(), Index(stream.size()));

      const Vector right = random_vector(rows, 5);
      Vector expected = right, found(rows + 1);
      triangle.triangularView<Eigen::Lower>().solveInPlace(expected.head(columns));
      expected.tail(below) -= beneath * expected.head(columns);
      Vector in_four_places(rows + 1);
      for (const StreamCount places : {StreamCount::four, StreamCount::one}) {
        found << right, 0.0;
        EXPECT_EQ(supernode_forward(stream.data(), columns, rows, found.data(), places), stream.data() + stream.size());
        EXPECT_LE((found.head(rows) - expected).cwiseAbs().maxCoeff(), 1e-14) << columns << " " << below;
        if (places == StreamCount::four) in_four_places = found;
        EXPECT_TRUE(found.head(rows) == in_four_places.head(rows)) << "forward solves have the same bits";
      }

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
      for (const StreamCount places : {StreamCount::four, StreamCount::one}) {
        found << right, 0.0;
        EXPECT_EQ(supernode_backward(stream.data() + stream.size(), columns, rows, found.data(), places),
                  stream.data());
        EXPECT_LE((found.head(rows) - expected).cwiseAbs().maxCoeff(), 1e-14) << columns << " " << below;
      }
    }
  }
}

/// A supernode shared by threads, compared with one thread, near the widths of strips and parts.
TEST(SupernodalKernels, AreSharedByThreads) {
  for (const Index columns : {32, 39, 40, 127, 128, 129, 135, 136, 137, 264}) {
    for (const Index below : {0, 1, 2, 3, 7, 8, 62, 65, 333}) {
      const Index rows = columns + below;
      std::mt19937 random(static_cast<unsigned>(31 * columns + below));
      Matrix factor = Matrix::NullaryExpr(rows, columns, [&] { return uniform(random) / 16.0; });
      factor.diagonal().array() += 2.0;
      const std::vector<double> stream = stream_of(factor);
      Vector right = random_vector(rows + 1, 6), forward = right, backward = right;
      right[rows] = forward[rows] = backward[rows] = 0.0;
      supernode_forward(stream.data(), columns, rows, forward.data());
      supernode_backward(stream.data() + stream.size(), columns, rows, backward.data());
      Vector sums(WideSupernode::sums_size()), first[2];
      for (const int threads : {1, 3}) {
        set_thread_count(threads);
        const WideSupernode wide(columns, rows, stream.data());
        Vector found[2] = {right, right};
        wide.forward(found[0].data());
        wide.backward(found[1].data(), sums.data());
        EXPECT_LE((found[0] - forward).head(rows).cwiseAbs().maxCoeff(), 1e-14) << columns << " " << below;
        EXPECT_LE((found[1] - backward).head(columns).cwiseAbs().maxCoeff(), 1e-14) << columns << " " << below;
        for (int k = 0; k < 2; ++k) {
          if (threads == 1) first[k] = found[k];
          EXPECT_TRUE(found[k] == first[k]) << columns << " " << below;
        }
      }
      set_thread_count(1);
    }
  }
}

/// A matrix large enough to be divided into subtrees.
class LargeFactor : public testing::Test {
 protected:
  ~LargeFactor() override { set_thread_count(1); }
  SparseMatrix matrix_ = grid_matrix(2, 110, 2, 1);
  SparseCholesky own_{matrix_};
  Index size_ = matrix_.cols();
};

TEST_F(LargeFactor, SolvesAsTheLibraryDoes) {
  SparseCholesky library(matrix_, SparseCholesky::Arithmetic::library);
  const Vector right = random_vector(size_, 3);
  EXPECT_GT(own_.work_size(), size_) << "not divided: nothing to test";
  EXPECT_LT(own_.factor_bytes(), 1.1 * double(library.factor_bytes()));
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
  const Vector right = random_vector(size_, 4);
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
  own_.forward(random_vector(size_, 5), y);
  for (const auto& at : places) {
    const FactorPath path = factor.path(at);
    Matrix column = Matrix::Zero(path.rows(), 1);
    Vector whole = Vector::Zero(own_.work_size());
    for (const Index place : at) {
      const auto k = std::size_t(std::ranges::upper_bound(path.first, place) - path.first.begin()) - 1;
      column(path.offsets[k] + place - path.first[k], 0) = 1.0 + double(place % 3);
      whole[place] = 1.0 + double(place % 3);
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
    Matrix columns = Matrix::Zero(path.rows(), Index(chosen.size()));
    const auto on_path = [&](Index place) {
      const auto k = std::size_t(std::ranges::upper_bound(path.first, place) - path.first.begin()) - 1;
      return path.offsets[k] + place - path.first[k];
    };
    Index at = 0;
    for (std::size_t j = 0; j < chosen.size(); ++j) {
      columns(on_path(chosen[j]), Index(j)) = 1.0;
      if (chosen[j] == wanted) at = Index(j);
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
}  // namespace ricochet::test_support
