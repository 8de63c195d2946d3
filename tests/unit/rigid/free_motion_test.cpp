#include "ricochet/rigid/free_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "ricochet/rigid/obstacle.hpp"

/// @file Rigid bodies that move by the forces on them: the identities of a step, rows, and a top with a closed form.
namespace ricochet {
namespace {

using Vector3 = Eigen::Vector3d;

FreeMotion::Inertia inertia(Index dimension) {
  FreeMotion::Inertia result;
  result.mass = 2.0;
  result.centre = Vector3(1.0, -2.0, 0.5).head(dimension);
  result.moments = Vector3(0.5, 0.8, 1.1).head(dimension == 2 ? 1 : 3);
  if (dimension == 3)
    result.principal = Eigen::AngleAxisd(0.7, Vector3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  return result;
}

/// A step under a force and a torque in space, built as schemes do.
class Stepped {
 public:
  explicit Stepped(FreeMotion::Inertia own) : motion(std::move(own), 0) {
    displacement.setZero(2 * motion.dimension());
    velocity = displacement;
  }
  void step(double h, const SpaceVector& force, const SpaceVector& torque) {
    motion.begin_step(displacement);
    const Index d = motion.dimension();
    const SpaceVector own = d == 3 ? SpaceVector(motion.axes_at_start().transpose() * torque) : torque;
    before = displacement;
    Vector end = displacement + h * velocity;
    for (int round = 0; round < 60; ++round) {
      Vector sum = Vector::Zero(2 * d);
      motion.add_gyroscopic_force(end, velocity, h, sum);
      sum.head(d) += force;
      sum.segment(d, own.size()) += own.cwiseQuotient(motion.gyration());
      const Vector next = displacement + h * velocity + h * h / (2.0 * motion.inertia().mass) * sum;
      const double change = (next - end).norm();
      end = next;
      if (change < 1e-17) break;
    }
    velocity = 2.0 / h * (end - displacement) - velocity;
    displacement = end;
  }
  [[nodiscard]] double energy() const { return 0.5 * motion.inertia().mass * velocity.squaredNorm(); }

  FreeMotion motion;
  Vector displacement, velocity, before;
};

class FreeMotions : public testing::TestWithParam<Index> {};

TEST_P(FreeMotions, KeepEnergyAndAngularMomentumOfAStepTogether) {
  const Index d = GetParam();
  Stepped body(inertia(d));
  const SpaceVector spin = Vector3(3.0, 1.0, -2.0).tail(d == 2 ? 1 : 3);
  body.velocity.segment(d, d) = body.motion.rotational_velocity(spin, body.displacement);
  EXPECT_LT((body.motion.angular_velocity(body.displacement, body.velocity) - spin).norm(), 1e-14);
  constexpr double h = 0.05;
  double largest = 0.0;
  for (int n = 0; n < 100; ++n) {
    const SpaceVector force = Vector3(0.3, std::cos(0.2 * n), -0.1).head(d);
    const SpaceVector torque = Vector3(0.1 * std::sin(n * h), 0.2, -0.1).tail(d == 2 ? 1 : 3);
    const double energy = body.energy();
    const SpaceVector momentum = body.motion.angular_momentum(body.displacement, body.velocity);
    body.step(h, force, torque);
    const Vector way = body.displacement - body.before;
    const SpaceVector own = way.segment(d, torque.size()).cwiseQuotient(body.motion.gyration());
    const SpaceVector turned = d == 3 ? SpaceVector(body.motion.axes_at_start() * own) : own;
    const double work = force.dot(way.head(d)) + turned.dot(torque);
    EXPECT_NEAR(body.energy() - energy, work, 2e-13 * energy);
    EXPECT_LT((body.motion.angular_momentum(body.displacement, body.velocity) - momentum - h * torque).norm(), 1e-13);
    largest = std::max(largest, turned.norm());
  }
  EXPECT_GT(largest, 0.1);
}

/// The rows give the displacement of a point of the body in a step exactly: Δc + θ × a, with the arm of its mean
/// position.
TEST_P(FreeMotions, MovePointsAsTheirRowsSay) {
  const Index d = GetParam();
  std::mt19937 random(3);
  const auto number = [&] { return 2.0 * double(random()) / 4294967296.0 - 1.0; };
  Stepped body(inertia(d));
  for (double& v : body.velocity) v = number();
  if (d == 2) body.velocity[3] = 0.0;
  for (int n = 0; n < 5; ++n)
    body.step(0.3, Vector3(1.0, 0.0, 2.0).head(d), Vector3(0.4, -0.3, 0.2).tail(d == 2 ? 1 : 3));
  const Vector way = body.displacement - body.before;
  const Pose before = body.motion.pose(body.before), after = body.motion.pose(body.displacement);
  for (int k = 0; k < 20; ++k) {
    SpaceVector of_shape(d), direction(d);
    for (double& x : of_shape) x = number();
    for (double& x : direction) x = number();
    const SpaceVector from = before.to_space(of_shape), to = after.to_space(of_shape), middle = 0.5 * (from + to);
    const SpaceVector arm = middle - 0.5 * (body.motion.centre(body.before) + body.motion.centre(body.displacement));
    Vector row(2 * d);
    body.motion.write_row(direction, arm, body.motion.axes_at_start(), row.data());
    EXPECT_NEAR(row.dot(way), direction.dot(to - from), 1e-14);
    EXPECT_LT((motion_at(before, after, middle) - (to - from)).norm(), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Dimensions, FreeMotions, testing::Values(Index{2}, Index{3}));

/// A top without torque: its axis circles the angular momentum at the rate |L|/J₁, to second order in the step.
TEST(FreeMotion, TurnsLikeATop) {
  FreeMotion::Inertia own;
  own.mass = 1.0;
  own.centre = Vector3::Zero();
  own.moments = Vector3(0.4, 0.4, 0.7);
  double error_before = 0.0;
  for (const int steps : {200, 400}) {
    Stepped body(own);
    const Vector3 spin(1.0, 0.0, 2.0), momentum = own.moments.cwiseProduct(spin);
    body.velocity.segment(3, 3) = body.motion.rotational_velocity(spin, body.displacement);
    constexpr double end = 3.0;
    for (int n = 0; n < steps; ++n) body.step(end / steps, Vector3::Zero(), Vector3::Zero());
    body.motion.begin_step(body.displacement);
    EXPECT_LT((body.motion.angular_momentum(body.displacement, body.velocity) - SpaceVector(momentum)).norm(), 1e-12);
    const Vector3 axis = body.motion.axes_at_start() * Vector3::UnitZ();
    const Vector3 exact = Eigen::AngleAxisd(end * momentum.norm() / 0.4, momentum.normalized()) * Vector3::UnitZ();
    const double error = (axis - exact).norm();
    EXPECT_LT(error, 2e-3);
    if (steps == 400) {
      EXPECT_NEAR(error_before / error, 4.0, 0.1);
    }
    error_before = error;
  }
}

}  // namespace
}  // namespace ricochet
