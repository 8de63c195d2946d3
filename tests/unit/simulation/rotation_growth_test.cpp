#include "ricochet/simulation/impact/rotation_growth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace ricochet {
namespace {

const Eigen::Vector3d down(0.0, -1.0, 0.0), up(0.0, 1.0, 0.0);

/// A disc that spins about z.
RotatingBody disc(double radius, double turn, double before, double after) {
  return {turn * Eigen::Vector3d::UnitZ(), before * Eigen::Vector3d::UnitZ(), after * Eigen::Vector3d::UnitZ(),
          radius * down};
}

/// The radius R √(1 + φ²) grows at the rate R φ ω.
TEST(TurnGrowth, OfASteadySpinIsThatOfTheRadius) {
  const double radius = 9.525e-3, spin = 800.0, duration = 54e-6, turn = 0.01;
  const double before = radius * turn * spin, after = radius * (turn + spin * duration) * spin;
  EXPECT_NEAR(rotation_growth(disc(radius, turn, spin, spin), down, duration), 0.5 * (before + after), 1e-12);
  EXPECT_NEAR(rotation_growth(disc(radius, 0.0, -spin, -spin), down, duration), 0.5 * radius * spin * spin * duration,
              1e-12);
  EXPECT_LT(rotation_growth(disc(radius, turn, -spin, -spin), down, 1e-9), 0.0) << "turns back";
  EXPECT_EQ(rotation_growth(disc(radius, 0.0, 0.0, 0.0), down, duration), 0.0);
}

/// A rotation about the normal moves no point along it, and a point on the axis not at all.
TEST(TurnGrowth, IsThatAcrossTheAxis) {
  RotatingBody top = disc(1.0, 0.0, 0.0, 0.0);
  top.rotation = 0.1 * up;
  top.spin_before = top.spin_after = 2.0 * up;
  EXPECT_EQ(rotation_growth(top, down, 0.25), 0.0);
  top.arm = {0.5, -1.0, 0.0};
  EXPECT_NEAR(rotation_growth(top, down, 0.25), 0.0, 1e-16);
  RotatingBody aslant = top;
  aslant.rotation = {0.0, 0.1, 0.1};
  aslant.spin_before = aslant.spin_after = {0.0, 0.0, 0.0};
  EXPECT_EQ(rotation_growth(aslant, down, 0.25), 0.0) << "it does not turn any more";
}

/// Velocity with which a mass on a spring leaves a floor that it reached at 1, with a growing radius.
double velocity_after(const std::function<double(double)>& growth) {
  constexpr double h = 1e-5;
  double height = 0.0, velocity = -1.0, grown = 0.0, time = 0.0;
  do {
    grown += h * growth(time + 0.5 * h);
    velocity += h * std::max(0.0, grown - height);
    height += h * velocity;
    time += h;
  } while (height < grown);
  return velocity;
}

/// Unit mass and stiffness, so that contact lasts π.
TEST(TurnGrowth, GivesTheVelocityAfter) {
  constexpr double pi = std::numbers::pi, turn = 0.004;
  EXPECT_NEAR(velocity_after([](double) { return 0.0; }), 1.0, 1e-4);
  for (const auto& [before, after] :
       {std::pair(0.05, 0.05), std::pair(0.0, 0.1), std::pair(0.05, 0.02), std::pair(0.08, 0.0)}) {
    const double change = after - before;
    const auto growth = [&, from = before](double t) {
      const double x = std::min(t, pi), s = 0.5 * (1.0 - std::cos(x)), spin = from + s * change;
      return (turn + from * x + 0.5 * change * (x - std::sin(x))) * spin;
    };
    const double expected = 2.0 * rotation_growth(disc(1.0, turn, before, after), down, pi);
    EXPECT_NEAR(velocity_after(growth) - 1.0, expected, 0.03 * expected) << before << " to " << after;
  }
}

TEST(TurnGrowth, ChangesARestitutionByTwiceItsPartOfTheApproach) {
  Impact impact;
  impact.mass = 2.0;
  impact.before.velocity = -0.5 * up;
  impact.after.velocity = 0.25 * up;
  impact.impulse = impact.normal_impulse = 1.5 * up;
  EXPECT_EQ(restitution_excess(impact), 0.0) << "no growth";
  for (const double sign : {-1.0, 1.0}) {
    impact.rotation_growth = sign * 0.002;
    EXPECT_NEAR(restitution_excess(impact), sign * 0.008, 1e-16);
    EXPECT_FALSE(is_distorted_by_rotation(impact));
    impact.rotation_growth = sign * 0.003;
    EXPECT_TRUE(is_distorted_by_rotation(impact));
  }
  impact.ended = false;
  EXPECT_FALSE(is_distorted_by_rotation(impact)) << "there is no restitution";
}

}  // namespace
}  // namespace ricochet
