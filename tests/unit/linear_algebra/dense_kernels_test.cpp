#include "ricochet/linear_algebra/dense_kernels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace ricochet {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

/// Columns of all lengths near the widths of registers, one to three of them, with gaps between them.
template <typename Number, typename Test>
void for_columns(const Test& test) {
  for (Index size = 0; size <= 70; ++size) {
    for (Index count = 1; count <= 3; ++count) {
      std::mt19937 random(static_cast<unsigned>(3 * size + count));
      const auto entry = [&] { return double(random()) / 2147483648.0 - 1.0; };
      const Matrix columns = Matrix::NullaryExpr(size + 3, count, entry);
      const Matrix rounded = columns.cast<Number>().template cast<double>();
      test(size, count, Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>(columns.cast<Number>()), rounded,
           Vector(Vector::NullaryExpr(count, entry)), Vector(Vector::NullaryExpr(size + 1, entry)));
    }
  }
}

template <typename Number>
void expect_sums() {
  for_columns<Number>([](Index size, Index count, const auto& columns, const Matrix& numbers, const Vector& factors,
                         const Vector& start) {
    Vector found = start;
    add_columns(size, count, columns.data(), columns.rows(), factors.data(), found.data());
    EXPECT_EQ(found[size], start[size]) << "behind the end";
    for (Index i = 0; i < size; ++i) {
      double expected = start[i], terms = std::abs(start[i]);
      for (Index k = 0; k < count; ++k) {
        expected += factors[k] * numbers(i, k);
        terms += std::abs(factors[k] * numbers(i, k));
      }
      // A sum of four terms: each of its roundings is at most half a unit of the terms' sum.
      EXPECT_LE(std::abs(found[i] - expected), 4.0 * rounding * terms) << size << " " << count << " " << i;
    }
  });
}

TEST(DenseKernels, AddColumns) {
  expect_sums<double>();
  expect_sums<float>();
}

TEST(DenseKernels, AddColumnsAndTheSizesOfTheirTerms) {
  for_columns<double>([](Index size, Index count, const Matrix& columns, const Matrix& numbers, const Vector& factors,
                         const Vector& start) {
    Vector found = start, sizes = start.cwiseAbs(), alone = start;
    add_columns(size, count, columns.data(), columns.rows(), factors.data(), found.data(), sizes.data());
    EXPECT_EQ(found[size], start[size]);
    EXPECT_EQ(sizes[size], std::abs(start[size]));
    add_columns(size, count, columns.data(), columns.rows(), factors.data(), alone.data());
    for (Index i = 0; i < size; ++i) {
      double terms = std::abs(start[i]);
      for (Index k = 0; k < count; ++k) terms += std::abs(factors[k] * numbers(i, k));
      EXPECT_LE(std::abs(sizes[i] - terms), 4.0 * rounding * terms);
      EXPECT_LE(std::abs(found[i] - alone[i]), 4.0 * rounding * terms);
    }
  });
}

}  // namespace
}  // namespace ricochet
