#include "ricochet/simulation/impact/restitution.hpp"

#include <gtest/gtest.h>

#include <string>

namespace ricochet {
namespace {

/// A body of mass 2 that reached a floor with this velocity (along x, and down), and leaves at half its approach plus
/// `more`; no other force acted.
Impact impact(double along, double down, double more = 0.0) {
  Impact result;
  result.mass = 2.0;
  result.before.velocity = {along, -down, 0.0};
  result.after.velocity = {along, 0.5 * down + more, 0.0};
  result.impulse = result.normal_impulse = result.mass * (result.after.velocity - result.before.velocity);
  result.before.kinetic_energy = result.before.rigid_kinetic_energy =
      0.5 * result.mass * result.before.velocity.squaredNorm();
  return result;
}

void expect_none(const Impact& given, const std::string& why) {
  EXPECT_FALSE(given.restitution().has_value());
  EXPECT_NE(why_no_restitution(given).find(why), std::string::npos) << why_no_restitution(given);
}

TEST(Restitution, IsTheRatioOfAClearApproach) {
  for (const double along : {0.0, 1.0, 20.0}) {
    const Impact clear = impact(along, 1.0);
    EXPECT_EQ(why_no_restitution(clear), "");
    ASSERT_TRUE(clear.restitution().has_value());
    EXPECT_NEAR(*clear.restitution(), 0.5, 1e-15);
  }
}

TEST(Restitution, IsNoneOfABodyThatStaysOrDidNotCome) {
  Impact stays = impact(0.0, 1.0);
  stays.ended = false;
  expect_none(stays, "still touches");
  Impact pushed_out = impact(0.0, 1.0);
  pushed_out.from_inside = true;
  expect_none(pushed_out, "began inside");
  expect_none(impact(1.0, 0.0, 1.0), "did not come nearer");
  expect_none(impact(1.0, -0.5, 1.0), "did not come nearer");
}

TEST(Restitution, IsDoubtedBelowZeroAndAboveOne) {
  EXPECT_EQ(restitution_doubt(impact(0.0, 1.0)), "");
  EXPECT_EQ(restitution_doubt(impact(0.0, 1.0, 0.5)), "");
  EXPECT_NE(restitution_doubt(impact(0.0, 1.0, -0.7)).find("still approaches"), std::string::npos);
  Impact fast = impact(0.0, 1.0, 1.0);
  EXPECT_NE(restitution_doubt(fast).find("above 1"), std::string::npos);
  fast.method_energy = 1.0;
  ASSERT_TRUE(restitution_error(fast).is_large) << "the method has created the energy, and that is said";
  EXPECT_EQ(restitution_doubt(fast), "");
}

/// The velocity that friction, vibrations or gravity give to a body that hardly approaches would be 1000 times its
/// approach velocity.
TEST(Restitution, IsNoneWhereOtherThingsMakeTheVelocityAfter) {
  expect_none(impact(1.0, 1e-4, 0.1), "along the obstacle");
  Impact vibrating = impact(0.0, 1e-4, 0.1);
  vibrating.before.kinetic_energy += 1.0;
  expect_none(vibrating, "spin and vibrations");
  Impact spinning = vibrating;
  spinning.before.rigid_kinetic_energy += 1.0;
  expect_none(spinning, "spin and vibrations");
  Impact pushed = impact(0.0, 1e-4, 0.1);
  pushed.impulse *= 0.5;
  expect_none(pushed, "other forces");
}

/// Units have no effect, nor has an obstacle that moves along with the body.
TEST(Restitution, LooksAtRatiosOnly) {
  for (const double unit : {1e-12, 1.0, 1e12}) {
    for (const double along : {50.0, 200.0}) {
      EXPECT_EQ(impact(along * unit, unit).restitution().has_value(), along < 100.0) << unit;
    }
  }
  Impact moving = impact(0.0, 1.0);
  moving.before.velocity[1] -= 1.0;
  moving.after.velocity[1] -= 1.0;
  moving.obstacle_velocity = -1.0;
  moving.before.kinetic_energy = moving.before.rigid_kinetic_energy =
      0.5 * moving.mass * moving.before.velocity.squaredNorm();
  ASSERT_TRUE(moving.restitution().has_value());
  EXPECT_NEAR(*moving.restitution(), 0.5, 1e-15);
}

/// Relative to a belt that moves along, the body does not slide; relative to a moving belt, a falling body does.
TEST(Restitution, LooksAtSlidingOnTheObstacle) {
  Impact carried = impact(200.0, 1.0);
  carried.obstacle_sliding = {200.0, 0.0, 0.0};
  ASSERT_TRUE(carried.restitution().has_value());
  EXPECT_NEAR(*carried.restitution(), 0.5, 1e-15);
  Impact dropped = impact(0.0, 1.0);
  dropped.obstacle_sliding = {200.0, 0.0, 0.0};
  expect_none(dropped, "along the obstacle");
}

/// Two bodies: that of `impact`, and one of mass 1 that goes up from below at 1, and down at 0.5 afterwards: they
/// separate at half their approach speed.
Impact impact_of_two() {
  Impact result = impact(0.0, 1.0);
  result.after.velocity = {0.0, 0.5, 0.0};
  result.other = OtherBody{1, 1.0, {}, {}};
  result.other->before.velocity = {0.0, 1.0, 0.0};
  result.other->after.velocity = {0.0, -0.5, 0.0};
  result.other->before.kinetic_energy = result.other->before.rigid_kinetic_energy = 0.5;
  // Of the impulse 2 · 1.5 = 3 on the first body, 1.5 acts on the second one; other forces supply the rest.
  result.impulse = result.normal_impulse = {0.0, 3.0, 0.0};
  return result;
}

TEST(Restitution, OfTwoBodiesIsThatOfTheirVelocityAgainstEachOther) {
  Impact two = impact_of_two();
  EXPECT_NEAR(two.normal_velocity_before(), -2.0, 1e-15);
  EXPECT_NEAR(two.normal_velocity_after(), 1.0, 1e-15);
  EXPECT_NEAR(two.approach_mass(), 2.0 / 3.0, 1e-15);
  ASSERT_TRUE(two.restitution().has_value()) << why_no_restitution(two);
  EXPECT_NEAR(*two.restitution(), 0.5, 1e-15);
  EXPECT_NEAR(two.other_impulse().norm(), 0.0, 1e-15);
  EXPECT_NEAR((two.other_impulse_on_other() - Eigen::Vector3d(0.0, 1.5, 0.0)).norm(), 0.0, 1e-15);
  // Results are independent of the observer.
  for (RigidMotionState* motion : {&two.before, &two.after, &two.other->before, &two.other->after})
    motion->velocity += Eigen::Vector3d(100.0, -100.0, 7.0);
  two.before.kinetic_energy = 0.5 * two.mass * two.before.velocity.squaredNorm();
  two.other->before.kinetic_energy = 0.5 * two.other->before.velocity.squaredNorm();
  ASSERT_TRUE(two.restitution().has_value()) << why_no_restitution(two);
  EXPECT_NEAR(*two.restitution(), 0.5, 1e-13);
  // The energy of the approach is ½ · 2/3 · 2² = 4/3, of which 3/4 is lost.
  two.method_energy = -0.99 / 10.0;
  EXPECT_FALSE(restitution_error(two).is_large);
  two.method_energy = -1.01 / 10.0;
  EXPECT_TRUE(restitution_error(two).is_large);
  EXPECT_NEAR(restitution_error(two).by_method, -0.101 / (4.0 / 3.0), 1e-13);
}

TEST(Restitution, OfTwoBodiesIsNoneWhereOtherThingsMakeTheVelocityAfter) {
  Impact stays = impact_of_two();
  stays.ended = false;
  expect_none(stays, "the bodies still touch");
  Impact overlapped = impact_of_two();
  overlapped.from_inside = true;
  expect_none(overlapped, "overlapped");
  Impact follows = impact_of_two();
  follows.other->before.velocity = {0.0, -2.0, 0.0};
  follows.other->before.kinetic_energy = 2.0;
  expect_none(follows, "did not come nearer");
  Impact vibrates = impact_of_two();
  vibrates.other->before.kinetic_energy += 0.5 * 30.0 * 30.0;
  expect_none(vibrates, "spins and vibrations");
  Impact slides = impact_of_two();
  slides.other->before.velocity[0] = 300.0;
  slides.other->before.kinetic_energy = 0.5 * slides.other->before.velocity.squaredNorm();
  expect_none(slides, "slid along each other");
  // Gravity gives both bodies the same velocity, and none to one relative to the other.
  Impact falls = impact_of_two();
  falls.impulse = falls.normal_impulse = {0.0, 1.5, 0.0};
  falls.after.velocity += Eigen::Vector3d(0.0, -0.75 - 100.0, 0.0);
  falls.other->after.velocity += Eigen::Vector3d(0.0, -100.0, 0.0);
  EXPECT_EQ(why_no_restitution(falls), "");
  falls.other->after.velocity[1] -= 100.0;
  expect_none(falls, "other forces gave them");
}

/// Supports of the second body can give it any impulse. It belongs to the ground, and the motion of its centre is
/// vibration, whichever body is named first.
TEST(Restitution, OfABodyThatMeetsAHeldOneIsItsOwn) {
  Impact onto_held = impact_of_two();
  onto_held.other->held = true;
  onto_held.other->before = onto_held.other->after = {};
  onto_held.other->after.velocity = {0.0, -0.3, 0.0};
  EXPECT_NEAR(onto_held.normal_velocity_before(), -1.0, 1e-15);
  EXPECT_NEAR(onto_held.normal_velocity_after(), 0.5, 1e-15);
  EXPECT_EQ(onto_held.approach_mass(), 2.0);
  ASSERT_TRUE(onto_held.restitution().has_value()) << why_no_restitution(onto_held);
  EXPECT_NEAR(*onto_held.restitution(), 0.5, 1e-15);
  Impact exchanged = onto_held;
  exchanged.held = true;
  std::swap(exchanged.mass, exchanged.other->mass);
  exchanged.other->held = false;
  std::swap(exchanged.before, exchanged.other->before);
  std::swap(exchanged.after, exchanged.other->after);
  exchanged.impulse = exchanged.normal_impulse = -onto_held.impulse;
  EXPECT_EQ(exchanged.approach_mass(), 2.0);
  ASSERT_TRUE(exchanged.restitution().has_value()) << why_no_restitution(exchanged);
  EXPECT_NEAR(*exchanged.restitution(), 0.5, 1e-15);
  // Its previous motion is vibration; two held bodies have no restitution, as supports give impulses to each.
  Impact vibrates = onto_held;
  vibrates.other->before.velocity = {0.0, 30.0, 0.0};
  vibrates.other->before.kinetic_energy = 0.5 * 30.0 * 30.0;
  expect_none(vibrates, "spins and vibrations");
  Impact both = onto_held;
  both.held = true;
  both.after.velocity = {0.0, 100.0, 0.0};
  expect_none(both, "other forces gave them");
}

/// At an approach of 1 the energy of a body of mass 2 is 1, and at a restitution of 0.5 it has lost 0.75.
TEST(Restitution, IsInexactWhereTheMethodDidATenthOfIt) {
  Impact lossy = impact(3.0, 1.0);
  EXPECT_FALSE(restitution_error(lossy).is_large) << "the method did nothing";
  for (const double sign : {-1.0, 1.0}) {
    lossy.method_energy = sign * 0.07;
    EXPECT_FALSE(restitution_error(lossy).is_large);
    lossy.method_energy = sign * 0.08;
    const RestitutionError error = restitution_error(lossy);
    EXPECT_TRUE(error.is_large);
    EXPECT_NEAR(error.by_method, sign * 0.08, 1e-15);
    EXPECT_NEAR(error.by_impact, 0.75, 1e-15);
  }
  lossy.ended = false;
  EXPECT_FALSE(restitution_error(lossy).is_large) << "there is no restitution";
  // A restitution of 1 has no loss to compare with: a change of the third digit is reported.
  Impact elastic = impact(0.0, 1.0, 0.5);
  elastic.method_energy = -0.0009;
  EXPECT_FALSE(restitution_error(elastic).is_large);
  elastic.method_energy = -0.0011;
  EXPECT_TRUE(restitution_error(elastic).is_large);
}

}  // namespace
}  // namespace ricochet
