#include "ricochet/linear_algebra/principal_factor.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/contact_problems.hpp"

namespace ricochet::test_support {
namespace {

Vector solve_afresh(const Matrix& w, const std::vector<Index>& indices, const Vector& right) {
  return Matrix(w(indices, indices)).llt().solve(right);
}

/// A walk through sets of indices: a few enter and leave at every step, and now and then many.
TEST(PrincipalFactor, FollowsItsIndices) {
  std::mt19937 random(1);
  const Index size = 80;
  const Matrix w = random_operator(size, 2.0, random);
  std::vector<char> in(static_cast<std::size_t>(size), 0);
  for (std::size_t i = 10; i < 60; ++i) in[i] = 1;
  PrincipalFactor factor;
  int factored = 0;
  for (int step = 0; step < 60; ++step) {
    SCOPED_TRACE(step);
    for (int k = 0; k < (step % 15 == 14 ? 30 : 2); ++k) in[random() % unsigned(size)] ^= 1;
    std::vector<Index> indices;
    for (std::size_t i = 0; i < in.size(); ++i) {
      if (in[i] != 0) indices.push_back(Index(i));
    }
    ASSERT_TRUE(factor.set_indices(w, indices));
    factored += factor.has_factored() ? 1 : 0;
    const Vector right = uniform(Index(indices.size()), random);
    Vector x;
    factor.solve(right, x);
    EXPECT_LE((x - solve_afresh(w, indices, right)).lpNorm<Eigen::Infinity>(), 1e-11 * x.lpNorm<Eigen::Infinity>());
  }
  EXPECT_LE(factored, 25);
  EXPECT_GE(factored, 3);
}

/// A factor that is recomputed from the base set has the same bits.
TEST(PrincipalFactor, IsMadeAgainFromItsBase) {
  std::mt19937 random(2);
  const Matrix w = random_operator(50, 2.0, random);
  std::vector<Index> base, changed;
  for (Index i = 0; i < 50; i += 1) {
    if (i % 5 != 0) base.push_back(i);
    if (i % 5 != 0 && i != 7 && i != 31) changed.push_back(i);
    if (i == 20) changed.push_back(i);
  }
  PrincipalFactor factor, again;
  ASSERT_TRUE(factor.set_indices(w, base));
  ASSERT_TRUE(factor.set_indices(w, changed));
  EXPECT_FALSE(factor.has_factored());
  ASSERT_TRUE(again.set_base(w, factor.base()));
  ASSERT_TRUE(again.set_indices(w, changed));
  const Vector right = uniform(Index(changed.size()), random);
  Vector x, y;
  factor.solve(right, x);
  again.solve(right, y);
  EXPECT_EQ(x, y);
}

TEST(PrincipalFactor, SaysWhereAMatrixIsNotDefinite) {
  PrincipalFactor factor;
  EXPECT_FALSE(factor.set_indices(Matrix::Ones(2, 2), {0, 1}));
  EXPECT_TRUE(factor.set_indices(Matrix::Ones(2, 2), {1}));
  Vector x;
  factor.solve(Vector::Constant(1, 3.0), x);
  EXPECT_EQ(x, Vector::Constant(1, 3.0));
}

}  // namespace
}  // namespace ricochet::test_support
