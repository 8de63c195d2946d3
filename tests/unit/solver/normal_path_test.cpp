#include "ricochet/solver/normal_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
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

/// U random and definite, gaps of either sign, some points not eligible.
Path random_path(unsigned seed, Index count) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto entry = [&] { return number(engine); };
  const Matrix b = Matrix::NullaryExpr(count, count, entry);
  Path path{b * b.transpose() + 0.05 * Matrix::Identity(count, count), Vector::NullaryExpr(count, entry),
            Vector::NullaryExpr(count, entry), std::vector<char>(static_cast<std::size_t>(count), 1)};
  for (char& may : path.eligible) may = entry() < -0.7 ? 0 : 1;
  return path;
}

/// The reactions at q by going through all sets of points that may press.
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
      allowed = allowed && path.eligible[static_cast<std::size_t>(i)] != 0;
    }
    if (!allowed) continue;
    Vector r = Vector::Zero(count);
    if (!pressing.empty()) {
      const Matrix block = path.u(pressing, pressing);
      const Vector solution = block.ldlt().solve(-Vector(q(pressing)));
      for (std::size_t i = 0; i < pressing.size(); ++i) r[pressing[i]] = solution[static_cast<Index>(i)];
    }
    const Vector y = q + path.u * r;
    double wrong = std::max(0.0, -r.minCoeff());
    for (Index i = 0; i < count; ++i)
      wrong = std::max(wrong, path.eligible[static_cast<std::size_t>(i)] != 0 ? -y[i] : 0.0);
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
    const Path path = random_path(seed, 1 + static_cast<Index>(seed % 6));
    NormalPath found(path.u, path.eligible);
    const Vector start = by_enumeration(path, path.q0), end = by_enumeration(path, path.q1);
    std::vector<char> pressing;
    for (Index i = 0; i < start.size(); ++i) pressing.push_back(seed % 2 == 0 && start[i] > 0.0 ? 1 : 0);
    ASSERT_TRUE(found.follow(path.q0, path.q1, pressing)) << seed;
    EXPECT_LT((found.start() - start).norm(), 1e-7 * (1.0 + start.norm())) << seed;
    EXPECT_LT((found.end() - end).norm(), 1e-7 * (1.0 + end.norm())) << seed;
    EXPECT_GE(found.mean().minCoeff(), -1e-12 * (1.0 + end.norm())) << seed;
    // The mean is the discrete gradient of the potential ½ rᵀ U r.
    const double potential = 0.5 * (end.dot(path.u * end) - start.dot(path.u * start));
    const double size = 1.0 + end.dot(path.u * end) + start.dot(path.u * start);
    EXPECT_NEAR(found.mean().dot(path.q1 - path.q0), -potential, 1e-12 * size) << seed;
    // Between the ends by midpoints of many small pieces.
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
    NormalPath found(path.u, path.eligible);
    const std::vector<char> none(4, 0);
    ASSERT_TRUE(found.follow(path.q0, path.q1, none));
    const Vector mean = found.mean();
    const Matrix derivative = found.mean_derivative();
    for (Index i = 0; i < 4; ++i) {
      ASSERT_TRUE(found.follow(path.q0, path.q1 + change * Vector::Unit(4, i), none));
      EXPECT_LT(((found.mean() - mean) / change + derivative.col(i)).norm(), 1e-4 * (1.0 + derivative.norm())) << seed;
    }
  }
}

}  // namespace
}  // namespace ricochet
