#include "ricochet/solver/mean_reaction/normal_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <random>

namespace ricochet {
namespace {

struct Path {
  Matrix u;
  Vector q0, q1;
  std::vector<char> eligible;
};

/// A path with U random and definite, gaps of either sign, and some ineligible points.
Path random_path(unsigned seed, Index count) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto entry = [&] { return number(engine); };
  const Matrix b = Matrix::NullaryExpr(count, count, entry);
  Path path{b * b.transpose() + 0.05 * Matrix::Identity(count, count), Vector::NullaryExpr(count, entry),
            Vector::NullaryExpr(count, entry), std::vector<char>(std::size_t(count), 1)};
  for (char& may : path.eligible) may = entry() < -0.7 ? 0 : 1;
  return path;
}

/// Reactions at q, found by enumerating all sets of pressing points.
Vector by_enumeration(const Path& path, const Vector& q) {
  const Index count = q.size();
  Vector best = Vector::Zero(count);
  double least = std::numeric_limits<double>::infinity();
  for (int set = 0; set < (1 << count); ++set) {
    std::vector<Index> pressing;
    bool allowed = true;
    for (Index i = 0; i < count; ++i) {
      if ((set >> i & 1) == 0) continue;
      pressing.push_back(i);
      allowed = allowed && path.eligible[std::size_t(i)] != 0;
    }
    if (!allowed) continue;
    Vector r = Vector::Zero(count);
    if (!pressing.empty()) {
      const Matrix block = path.u(pressing, pressing);
      const Vector solution = block.partialPivLu().solve(-Vector(q(pressing)));
      for (std::size_t i = 0; i < pressing.size(); ++i) r[pressing[i]] = solution[Index(i)];
    }
    const Vector y = q + path.u * r;
    double wrong = std::max(0.0, -r.minCoeff());
    for (Index i = 0; i < count; ++i) wrong = std::max(wrong, path.eligible[std::size_t(i)] != 0 ? -y[i] : 0.0);
    if (wrong < least) {
      least = wrong;
      best = r;
    }
  }
  EXPECT_LT(least, 1e-9);
  return best;
}

TEST(NormalPath, EndsAndItsMeanAreRight) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Path path = random_path(seed, 1 + Index(seed % 6));
    NormalPath found;
    found.prepare(path.u, seed % 3 == 0 ? PathMatrix::semidefinite : PathMatrix::definite);
    const Vector start = by_enumeration(path, path.q0), end = by_enumeration(path, path.q1);
    std::vector<char> pressing;
    for (Index i = 0; i < start.size(); ++i) pressing.push_back(seed % 2 == 0 && start[i] > 0.0 ? 1 : 0);
    ASSERT_TRUE(found.follow(path.q0, path.q1, path.eligible, pressing)) << seed;
    EXPECT_LT((found.start() - start).norm(), 1e-7 * (1.0 + start.norm())) << seed;
    EXPECT_LT((found.end() - end).norm(), 1e-7 * (1.0 + end.norm())) << seed;
    EXPECT_GE(found.mean().minCoeff(), -1e-12 * (1.0 + end.norm())) << seed;
    // The mean is the discrete gradient of the potential ½ rᵀ U r.
    const double potential = 0.5 * (end.dot(path.u * end) - start.dot(path.u * start));
    const double size = 1.0 + end.dot(path.u * end) + start.dot(path.u * start);
    EXPECT_NEAR(found.mean().dot(path.q1 - path.q0), -potential, 1e-12 * size) << seed;
    // Midpoint rule on many small pieces between the ends.
    Vector sum = Vector::Zero(end.size());
    constexpr int parts = 400;
    for (int k = 0; k < parts; ++k) sum += by_enumeration(path, path.q0 + ((k + 0.5) / parts) * (path.q1 - path.q0));
    EXPECT_LT((found.mean() - sum / parts).norm(), 1e-4 * (1.0 + sum.norm() / parts)) << seed;
  }
}

TEST(NormalPath, DerivativesAreThoseOfDifferences) {
  constexpr double change = 1e-6;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Path path = random_path(seed, 4);
    NormalPath found;
    found.prepare(path.u, PathMatrix::definite);
    found.keep_derivatives(true);
    const std::vector<char> none(4, 0);
    ASSERT_TRUE(found.follow(path.q0, path.q1, path.eligible, none));
    const Vector mean = found.mean();
    const Matrix derivative = found.mean_derivative();
    for (Index i = 0; i < 4; ++i) {
      ASSERT_TRUE(found.follow(path.q0, path.q1 + change * Vector::Unit(4, i), path.eligible, none));
      EXPECT_LT(((found.mean() - mean) / change + derivative.col(i)).norm(), 1e-4 * (1.0 + derivative.norm())) << seed;
    }
  }
}

/// Without symmetry, as under friction proportional to the normal reactions, the conditions hold along the path.
TEST(NormalPath, TakesMatricesWithoutSymmetry) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Path path = random_path(seed, 1 + Index(seed % 6));
    const Matrix skew = path.u.triangularView<Eigen::StrictlyUpper>();
    path.u += 0.3 * (skew - skew.transpose());
    NormalPath found;
    found.prepare(path.u, PathMatrix::general);
    const std::vector<char> none(static_cast<std::size_t>(path.q0.size()), 0);
    ASSERT_TRUE(found.follow(path.q0, path.q1, path.eligible, none)) << seed;
    for (const double time : {1e-8, 0.31, 0.77, 1.0}) {
      const Vector q = path.q0 + time * (path.q1 - path.q0), r = by_enumeration(path, q);
      std::size_t k = 0;
      while (found.piece(k).end < time) ++k;
      const NormalPath::Piece& piece = found.piece(k);
      const double part = (time - piece.begin) / (piece.end - piece.begin);
      EXPECT_LT((piece.first + part * (piece.last - piece.first) - r).norm(), 1e-7 * (1.0 + r.norm())) << seed;
    }
  }
}

/// More points than degrees of freedom: gaps and forces are unique, and some of the points carry the reactions.
TEST(NormalPath, TakesPointsThatDependOnOneAnother) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto entry = [&] { return number(engine); };
  for (int seed = 0; seed < 200; ++seed) {
    const Index motions = 1 + seed % 5, count = 2 * motions;
    // Rows of nonnegative weights, as from multipliers on facets, of points with a definite compliance.
    const Matrix weights = Matrix::NullaryExpr(count, motions, [&] { return std::max(0.0, number(engine)) + 0.01; });
    const Matrix b = Matrix::NullaryExpr(motions, motions, entry);
    const Matrix compliance = b * b.transpose() + 0.1 * Matrix::Identity(motions, motions);
    const Path path{weights * compliance * weights.transpose(), weights * Vector::NullaryExpr(motions, entry),
                    weights * Vector::NullaryExpr(motions, entry), std::vector<char>(std::size_t(count), 1)};
    NormalPath found;
    found.prepare(path.u, PathMatrix::semidefinite);
    const std::vector<char> all(static_cast<std::size_t>(count), 1);
    ASSERT_TRUE(found.follow(path.q0, path.q1, path.eligible, all)) << seed;
    for (const auto& [q, r] : {std::pair(path.q0, found.start()), std::pair(path.q1, found.end())}) {
      const Vector gap = q + path.u * r;
      const double size = 1.0 + r.norm();
      EXPECT_GE(r.minCoeff(), -1e-10 * size) << seed;
      EXPECT_GE(gap.minCoeff(), -1e-9 * size) << seed;
      EXPECT_NEAR(r.dot(gap), 0.0, 1e-9 * size * size) << seed;
    }
    const Vector start = found.start(), end = found.end();
    const double potential = 0.5 * (end.dot(path.u * end) - start.dot(path.u * start));
    const double size = 1.0 + end.dot(path.u * end) + start.dot(path.u * start);
    EXPECT_NEAR(found.mean().dot(path.q1 - path.q0), -potential, 1e-10 * size) << seed;
  }
}

}  // namespace
}  // namespace ricochet
