#include "ricochet/linear_algebra/unsymmetric_factor.hpp"

#include <gtest/gtest.h>

#include <random>

namespace ricochet {
namespace {

SparseMatrix random_matrix(Index size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::uniform_int_distribution<int> place(0, int(size) - 1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < int(size); ++i) {
    entries.emplace_back(i, (i + 1) % int(size), 1.0);  // no entry on the diagonal is needed
    for (int k = 0; k < 4; ++k) entries.emplace_back(i, place(random), number(random));
  }
  SparseMatrix result(size, size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

TEST(UnsymmetricFactor, SolvesIndefiniteSystems) {
  UnsymmetricFactor factor;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const SparseMatrix a = random_matrix(200, seed);
    const Vector expected = Vector::LinSpaced(200, -1.0, 2.0);
    EXPECT_GT(factor.analyse(a), 0.0);
    ASSERT_TRUE(factor.factorize());
    Vector x;
    factor.solve(a * expected, x);
    EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(UnsymmetricFactor, RefusesSingularMatrices) {
  UnsymmetricFactor factor;
  SparseMatrix a(3, 3);
  a.insert(0, 0) = 1.0;
  a.insert(1, 1) = 1.0;
  factor.analyse(a);
  EXPECT_FALSE(factor.factorize());
  a.insert(2, 2) = std::numeric_limits<double>::quiet_NaN();
  factor.analyse(a);
  Vector x;
  if (factor.factorize()) {
    factor.solve(Vector::Ones(3), x);
    EXPECT_FALSE(x.allFinite());
  }
}

}  // namespace
}  // namespace ricochet
