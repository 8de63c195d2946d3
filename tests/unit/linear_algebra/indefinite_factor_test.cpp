#include "ricochet/linear_algebra/indefinite_factor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ricochet {
namespace {

/// Second differences on a line, shifted: eigenvalues 2 − 2 cos(kπ/(n+1)) − shift, k = 1 … n.
SparseMatrix shifted_laplacian(Index size, double shift) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < size; ++i) {
    entries.emplace_back(int(i), int(i), 2.0 - shift);
    if (i + 1 == size) continue;
    entries.emplace_back(int(i), int(i + 1), -1.0);
    entries.emplace_back(int(i + 1), int(i), -1.0);
  }
  SparseMatrix result(size, size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

double eigenvalue(Index number, Index size) { return 2.0 - 2.0 * std::cos(double(number) * M_PI / double(size + 1)); }

TEST(IndefiniteFactor, CountsNegativeEigenvalues) {
  constexpr Index size = 30;
  for (const Index below : {0, 1, 2, 7, 30}) {
    const double shift =
        below == size ? 5.0 : 0.5 * ((below > 0 ? eigenvalue(below, size) : 0.0) + eigenvalue(below + 1, size));
    IndefiniteFactor factor;
    ASSERT_TRUE(factor.factorize(shifted_laplacian(size, shift)));
    EXPECT_EQ(factor.negative_eigenvalues(), below);
  }
}

TEST(IndefiniteFactor, Solves) {
  const SparseMatrix matrix = shifted_laplacian(20, 0.3);
  IndefiniteFactor factor;
  ASSERT_TRUE(factor.factorize(matrix));
  const Vector right = Vector::LinSpaced(20, -1.0, 2.0);
  Vector x;
  factor.solve(right, x);
  EXPECT_LT((matrix * x - right).norm(), 1e-12 * right.norm());
}

/// The eigenvector of the only negative eigenvalue is the half wave.
TEST(IndefiniteFactor, FindsTheNegativeDirection) {
  constexpr Index size = 30;
  const SparseMatrix matrix = shifted_laplacian(size, 0.9 * eigenvalue(1, size) + 0.1 * eigenvalue(2, size));
  IndefiniteFactor factor;
  ASSERT_TRUE(factor.factorize(matrix));
  Vector x;
  factor.find_negative_direction(matrix, x);
  EXPECT_NEAR(x.norm(), 1.0, 1e-14);
  EXPECT_LT(x.dot(matrix * x), 0.0);
  Vector wave = Vector::NullaryExpr(size, [](Index i) { return std::sin(double(i + 1) * M_PI / double(size + 1)); });
  wave.normalize();
  EXPECT_NEAR(x.dot(wave), 1.0, 1e-3);
}

TEST(IndefiniteFactor, RefusesAPivotOfZero) {
  SparseMatrix matrix(2, 2);
  matrix.insert(0, 1) = 1.0;
  matrix.insert(1, 0) = 1.0;
  EXPECT_FALSE(IndefiniteFactor().factorize(matrix));
}

}  // namespace
}  // namespace ricochet
