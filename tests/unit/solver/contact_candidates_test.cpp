#include "ricochet/solver/delassus/contact_candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ricochet {
namespace {

/// Conditions with all points eligible, y = gap + Gδ.
ContactConditions conditions_with_gaps(const Vector& gaps) {
  ContactConditions conditions;
  conditions.gap.offset = gaps;
  conditions.gap.rounding = Vector::Constant(gaps.size(), 1e-15);
  conditions.eligible.assign(std::size_t(gaps.size()), 1);
  return conditions;
}

Vector gaps(std::initializer_list<double> values) {
  return Eigen::Map<const Vector>(values.begin(), Index(values.size()));
}

using PointNumbers = std::vector<Index>;

bool some_may_touch(ContactCandidates& candidates, const ContactConditions& conditions) {
  candidates.estimate_reach(conditions);
  return candidates.some_may_touch(conditions);
}

PointNumbers approaching(ContactCandidates& candidates, const ContactConditions& conditions) {
  candidates.estimate_reach(conditions);
  return candidates.approaching(conditions);
}

PointNumbers worth_keeping(ContactCandidates& candidates, const ContactConditions& conditions) {
  candidates.estimate_reach(conditions);
  return candidates.worth_keeping(conditions);
}

TEST(ContactCandidates, AreNoneFarFromTheObstacle) {
  ContactCandidates candidates(3);
  const ContactConditions conditions = conditions_with_gaps(gaps({1.0, 2.0, 3.0}));
  EXPECT_FALSE(some_may_touch(candidates, conditions));
  EXPECT_EQ(approaching(candidates, conditions), PointNumbers{});
  EXPECT_EQ(candidates.penetrating(conditions, gaps({-0.9, -1.9, -2.9}), false), PointNumbers{});
}

TEST(ContactCandidates, TakeUpPointsInsideTheObstacleAndThoseWithinReachOfThem) {
  ContactCandidates candidates(5);
  // Inside by 1: the stage moves points by that, and by twice that at most; points within eight times that are added.
  const ContactConditions conditions = conditions_with_gaps(gaps({20.0, -1.0, 15.9, 0.5, 1.9}));
  EXPECT_TRUE(some_may_touch(candidates, conditions));
  EXPECT_EQ(approaching(candidates, conditions), (PointNumbers{1, 2, 3, 4}));
  candidates.add_candidates({1, 2, 3, 4});
  EXPECT_EQ(approaching(candidates, conditions), PointNumbers{});
  EXPECT_EQ(candidates.number(1), 0);
  EXPECT_EQ(candidates.number(4), 3);
  EXPECT_EQ(candidates.number(0), -1);
}

TEST(ContactCandidates, ReachIsWhatTheLastStageMovedPointsBy) {
  ContactCandidates candidates(2);
  ContactConditions conditions = conditions_with_gaps(gaps({1.5, 100.0}));
  EXPECT_FALSE(some_may_touch(candidates, conditions));
  candidates.update_history(conditions, gaps({-1.0, 0.2}), 0);
  EXPECT_TRUE(some_may_touch(candidates, conditions));
  EXPECT_EQ(approaching(candidates, conditions), (PointNumbers{0}));
  conditions.gap.factor = 0.5;  // y = q + s G δ
  EXPECT_FALSE(some_may_touch(candidates, conditions));
}

TEST(ContactCandidates, NeverAreWhatMayNotTouch) {
  ContactCandidates candidates(2);
  ContactConditions conditions = conditions_with_gaps(gaps({-1.0, -1.0}));
  conditions.eligible = {0, 1};
  EXPECT_EQ(approaching(candidates, conditions), (PointNumbers{1}));
  EXPECT_EQ(candidates.penetrating(conditions, gaps({-1.0, -1.0}), false), (PointNumbers{1}));
  conditions.eligible = {0, 0};
  EXPECT_FALSE(some_may_touch(candidates, conditions));
  EXPECT_EQ(candidates.penetrating(conditions, gaps({-1.0, -1.0}), false), PointNumbers{});
}

TEST(ContactCandidates, AreAskedForWhereOthersPenetrate) {
  ContactCandidates candidates(4);
  const ContactConditions conditions = conditions_with_gaps(gaps({1.0, 1.0, 1.0, 1.0}));
  candidates.add_candidates({0});
  // 0 is a candidate, so the solver handles its gap. 2 is deepest, 1 less than half as deep, 3 inside by rounding only.
  EXPECT_EQ(candidates.penetrating(conditions, gaps({-9.0, -1.4, -2.0, -1.0 - 5e-16}), false), (PointNumbers{2}));
  EXPECT_EQ(candidates.penetrating(conditions, gaps({0.0, -1.6, -2.0, 0.0}), false), (PointNumbers{2, 1}));
  EXPECT_EQ(candidates.penetrating(conditions, gaps({0.0, 0.0, 0.0, -1.0 - 5e-16}), false), PointNumbers{});
  EXPECT_EQ(candidates.penetrating(conditions, gaps({-9.0, 0.0, 0.0, 0.0}), true), (PointNumbers{0}))
      << "no request included it";
}

/// An unsupported body falls through its obstacle with all points, which are not all added at once.
TEST(ContactCandidates, DoubleAtMost) {
  const Index count = 1000;
  ContactCandidates candidates(count);
  const ContactConditions conditions = conditions_with_gaps(Vector::LinSpaced(count, 0.0, 1.0));
  const Vector fallen = Vector::Constant(count, -1e6);
  std::size_t rounds = 0;
  for (PointNumbers found = candidates.penetrating(conditions, fallen, false); !found.empty();
       found = candidates.penetrating(conditions, fallen, false), ++rounds) {
    EXPECT_LE(found.size(), std::max<std::size_t>(32, candidates.points().size()));
    EXPECT_EQ(found.front(), Index(candidates.points().size())) << "the deepest first";
    candidates.add_candidates(found);
  }
  EXPECT_EQ(candidates.points().size(), 1000U);
  EXPECT_LE(rounds, 6U);
}

TEST(ContactCandidates, AreDroppedWhenTheyHaveBeenFarForLong) {
  const Index count = 200;
  ContactCandidates candidates(count);
  Vector distance = Vector::Zero(count);
  candidates.add_candidates(approaching(candidates, conditions_with_gaps(distance)));
  ASSERT_EQ(candidates.points().size(), 200U);
  distance.tail(count - 3).setConstant(50.0);
  distance[0] = -0.01;
  PointNumbers kept;
  int stages = 0;
  while (kept.empty() && stages < 1000) {
    kept = worth_keeping(candidates, conditions_with_gaps(distance));
    ++stages;
  }
  EXPECT_EQ(kept, (PointNumbers{0, 1, 2}));
  EXPECT_GT(stages, 20) << "not at once: a body that bounces comes back";
  EXPECT_LT(stages, 1000);
  candidates.clear();
  EXPECT_EQ(candidates.number(0), -1);
  EXPECT_TRUE(candidates.points().empty());
}

/// A body that moves by more than its own size in a step may touch with every point, and does with few.
TEST(ContactCandidates, AreTheNearestOfManyThatMayTouch) {
  const Index count = 10000;
  ContactCandidates candidates(count);
  Vector distance(count);
  for (Index i = 0; i < count; ++i) distance[i] = double(i * 7919 % count + 1);
  const ContactConditions conditions = conditions_with_gaps(distance);
  candidates.update_history(conditions, Vector::Constant(count, -1e5), 0);
  const PointNumbers taken = approaching(candidates, conditions);
  ASSERT_GE(taken.size(), 100U);
  EXPECT_LE(taken.size(), 600U);
  for (const Index point : taken) EXPECT_LE(distance[point], double(taken.size()));
  candidates.add_candidates(taken);
  EXPECT_EQ(approaching(candidates, conditions), PointNumbers{}) << "the others are asked for where they penetrate";
  // Many loaded points have many neighbours.
  candidates.update_history(conditions, Vector::Constant(count, -1e5), 1000);
  const std::size_t all = taken.size() + approaching(candidates, conditions).size();
  EXPECT_GE(all, 2000U);
  EXPECT_LE(all, 4000U);
}

/// A wheel of 4,000 points rolls one turn: each point reaches the floor and leaves it. Points that have left are
/// dropped.
TEST(ContactCandidates, StayFewOnAWheelThatRolls) {
  const Index count = 4000;
  const int steps = 400;
  ContactCandidates candidates(count);
  const auto height = [&](double turn) {
    Vector result(count);
    for (Index i = 0; i < count; ++i)
      result[i] = 1.0 - std::cos(2.0 * std::numbers::pi * (double(i) / double(count) - turn));
    return result;
  };
  std::vector<char> came(static_cast<std::size_t>(count), 0);
  std::size_t most = 0;
  for (int step = 0; step < steps; ++step) {
    const Vector now = height(double(step) / steps);
    const ContactConditions conditions = conditions_with_gaps(now);
    if (const PointNumbers kept = worth_keeping(candidates, conditions); !kept.empty()) {
      candidates.clear();
      candidates.add_candidates(kept);
    }
    candidates.add_candidates(approaching(candidates, conditions));
    for (const Index point : candidates.points()) came[std::size_t(point)] = 1;
    most = std::max(most, candidates.points().size());
    candidates.update_history(conditions, height(double(step + 1) / steps) - now, 5);
  }
  EXPECT_EQ(std::ranges::count(came, 1), count);
  EXPECT_LE(most, 3000U);
}

}  // namespace
}  // namespace ricochet
