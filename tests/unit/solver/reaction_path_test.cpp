#include "ricochet/solver/mean_reaction/reaction_path.hpp"

#include <gtest/gtest.h>

#include <random>

// Reactions along the path of a step, with friction: with Φ = ½ ρᵀUρ and Coulomb's law at its start and end,
//   ρ̄·(q₁ − q₀) + Φ₁ − Φ₀ = −r(0+)·g₀ + work of friction − ½ jᵀUj,   j = ρ(0+) − ρ₀,
// which is equation (3) of docs/energy.md.

namespace ricochet {
namespace {

class RandomStep {
 public:
  RandomStep(unsigned seed, Index points, Index dimension) : engine_(seed) {
    const Index rows = points * dimension;
    for (Index i = 0; i <= points; ++i) row_offset.push_back(i * dimension);
    const Matrix b = Matrix::NullaryExpr(rows, rows, [&] { return number(); });
    u = b * b.transpose() + 0.3 * Matrix::Identity(rows, rows);
    friction = Vector::NullaryExpr(points, [&] { return 0.5 * std::abs(number()); });
    for (Index i = 0; i < points; ++i) slips_.push_back(number() > 0.0);
    start.setZero(rows);
    end.setZero(rows);
    q0.setZero(rows);
    q1.setZero(rows);
    for (Index i = 0; i < points; ++i) {
      take_state(i, start, q0, false);
      take_state(i, end, q1, true);
      pressing.push_back(start[row_offset[std::size_t(i)]] > 0.0 ? 1 : 0);
    }
    q0 -= u * start;
    q1 -= u * end;
    eligible.assign(std::size_t(points), 1);
  }

  [[nodiscard]] ReactionPath::Step step() const { return {q0, q1, start, end, friction, eligible, pressing}; }
  [[nodiscard]] double gap_at_start(Index point) const {
    const Index row = row_offset[std::size_t(point)];
    return q0[row] + u.row(row).dot(start);
  }
  [[nodiscard]] bool slips_at_end(Index point) const {
    return slips_[std::size_t(point)] && end[row_offset[std::size_t(point)]] > 0.0;
  }

  Matrix u;
  std::vector<Index> row_offset;
  Vector q0, q1, start, end, friction;
  std::vector<char> eligible, pressing;

 private:
  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(engine_); }

  /// Draws a state of Coulomb's law at one point: reactions, and gap and slip (zero at the start) in `motion`.
  void take_state(Index point, Vector& reaction, Vector& motion, bool is_end) {
    const Index row = row_offset[std::size_t(point)];
    const Index tangents = row_offset[std::size_t(point) + 1] - row - 1;
    if (number() < -0.3) {
      motion[row] = std::abs(number());
      for (Index k = 1; k <= tangents && is_end; ++k) motion[row + k] = number();
      return;
    }
    reaction[row] = 0.1 + std::abs(number());
    Vector direction = Vector::NullaryExpr(tangents, [&] { return number(); });
    direction /= direction.norm();
    const double limit = friction[point] * reaction[row];
    const bool slips = slips_[std::size_t(point)];
    reaction.segment(row + 1, tangents) = (slips ? limit : 0.6 * limit) * direction;
    if (slips && is_end) motion.segment(row + 1, tangents) = -std::abs(number()) * direction;
  }

  std::mt19937 engine_;
  std::vector<bool> slips_;
};

TEST(ReactionPath, LosesEnergyAtEachPartAndStaysOnTheCone) {
  int on_cone = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    const RandomStep random(seed, 1 + Index(seed % 5), 2 + Index(seed % 2));
    ReactionPath path;
    path.prepare(random.u, random.row_offset, true);
    ASSERT_TRUE(path.follow(random.step())) << seed;
    double at_start = 0.0;
    for (Index i = 0; i < random.friction.size(); ++i) {
      at_start += path.start()[i] * random.gap_at_start(i);
      const Index row = random.row_offset[std::size_t(i)];
      const Index tangents = random.row_offset[std::size_t(i) + 1] - row - 1;
      EXPECT_GE(path.mean()[row], -1e-12) << seed;
      if (!random.slips_at_end(i)) continue;
      const Vector along = random.end.segment(row + 1, tangents) / random.end[row] * path.mean()[row];
      on_cone += (path.mean().segment(row + 1, tangents) - along).norm() < 1e-10 * (1.0 + along.norm()) ? 1 : 0;
    }
    const double potential = 0.5 * (random.end.dot(random.u * random.end) - random.start.dot(random.u * random.start));
    const double size = 1.0 + random.end.dot(random.u * random.end) + random.start.dot(random.u * random.start) +
                        path.mean().norm() * (random.q1 - random.q0).norm();
    const double of_jump = path.mean().dot(random.q1 - random.q0) + potential + at_start - path.friction_work();
    EXPECT_LE(of_jump, 1e-12 * size) << seed;
    EXPECT_LE(path.friction_work(), 1e-11 * size) << seed;
    EXPECT_GE(at_start, -1e-12 * size) << seed;
  }
  EXPECT_GT(on_cone, 200);
}

/// Points that stick, or continue to slip, have no jump: energy is lost to friction only.
TEST(ReactionPath, LosesNothingWhereFrictionGoesOn) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> number(0.2, 1.0);
  for (int k = 0; k < 100; ++k) {
    Matrix b = Matrix::NullaryExpr(4, 4, [&] { return number(engine) - 0.6; });
    const Matrix u = b * b.transpose() + 0.3 * Matrix::Identity(4, 4);
    const Vector friction = Vector::Constant(2, 0.4);
    Vector start(4), end(4), y1 = Vector::Zero(4);
    // The first point slips to the right, the second sticks.
    const double r0 = number(engine), r1 = number(engine);
    start << r0, -0.4 * r0, number(engine), 0.1;
    end << r1, -0.4 * r1, number(engine), -0.05;
    y1[1] = number(engine);
    const Vector q0 = -(u * start), q1 = y1 - u * end;
    const std::vector<char> all(2, 1);
    ReactionPath path;
    path.prepare(u, {0, 2, 4}, true);
    ASSERT_TRUE(path.follow({q0, q1, start, end, friction, all, all}));
    const double potential = 0.5 * (end.dot(u * end) - start.dot(u * start));
    EXPECT_NEAR(path.mean().dot(q1 - q0) + potential, path.friction_work(), 1e-14);
    EXPECT_NEAR(path.mean()[1], -0.4 * path.mean()[0], 1e-14);
    EXPECT_NEAR(path.mean()[0], 0.5 * (r0 + r1), 1e-13);
    EXPECT_NEAR(path.mean()[3], 0.025, 1e-14);
    EXPECT_LT(path.friction_work(), 0.0);
  }
}

/// If U_NN + U_NT D is no P-matrix, the cone has another path, along which all contact would open; it is rejected.
TEST(ReactionPath, TakesNoPathThatEndsElsewhere) {
  Matrix u(2, 2);
  u << 1.0, 1.5, 1.5, 4.0;
  const Vector start = Vector::Zero(2), end = (Vector(2) << 1.0, -1.0).finished(),
               q0 = (Vector(2) << 1.0, 0.0).finished();
  const Vector q1 = (Vector(2) << 0.5, 3.0).finished(), friction = Vector::Constant(1, 1.0);
  ASSERT_NEAR((q1 + u * end)[0], 0.0, 1e-15);  // closed at the end
  const std::vector<char> eligible(1, 1), none(1, 0);
  ReactionPath path;
  path.prepare(u, {0, 2}, true);
  ASSERT_TRUE(path.follow({q0, q1, start, end, friction, eligible, none}));
  EXPECT_GT(path.mean()[0], 0.0);
  EXPECT_LE(path.friction_work(), 1e-14);
  const double change = path.mean().dot(q1 - q0) + 0.5 * end.dot(u * end) + path.start()[0] * q0[0];
  EXPECT_LE(change, path.friction_work() + 1e-14);
}

/// Points enter and leave, and the inverse on the present ones stays exact.
TEST(PressingSet, KeepsTheInverse) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  constexpr Index count = 12;
  const Matrix b = Matrix::NullaryExpr(count, count, [&] { return number(engine); });
  const Matrix u = b * b.transpose() + 0.1 * Matrix::Identity(count, count) + 0.1 * b;
  PressingSet set;
  set.prepare(u);
  std::vector<char> marks(count, 0);
  for (int k = 0; k < 400; ++k) {
    const int changes = k % 7 == 0 ? 5 : 1;
    for (int c = 0; c < changes; ++c) {
      char& mark = marks[std::size_t(engine() % count)];
      mark = mark == 0 ? 1 : 0;
    }
    ASSERT_TRUE(set.set_points(marks));
    const Vector q = Vector::NullaryExpr(count, [&] { return number(engine); });
    Vector r, y = q;
    set.solve(q, r);
    set.add_motion(r, y);
    Matrix sum = Matrix::Zero(count, count);
    set.add_inverse(1.0, sum);
    EXPECT_LT((sum * q + r).norm(), 1e-12 * (1.0 + r.norm()));
    for (Index i = 0; i < count; ++i) {
      if (marks[std::size_t(i)] != 0) {
        EXPECT_NEAR(y[i], 0.0, 1e-9 * (1.0 + r.norm()));
      } else {
        EXPECT_EQ(r[i], 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace ricochet
