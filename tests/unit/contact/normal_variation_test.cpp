#include "ricochet/contact/mortar/normal_variation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/contact/mortar/choose_side.hpp"
#include "support/two_bodies.hpp"

/// @file A flat body below a round one: within a facet of size h the normals of a circle of radius R rotate by h/R,
/// those of the flat side not at all, and vice versa only where the circle can touch it.
namespace ricochet::test_support {
namespace {

constexpr double radius = 2.0;

/// The upper body has a round lower side of width 1, the lower one a flat upper side.
StackedBoxes round_on_flat(int flat_cells, int round_cells, int degree) {
  StackedBoxes stack;
  stack.lower_counts = {flat_cells, 2};
  stack.upper_counts = {round_cells, 2};
  stack.geometry_degree = degree;
  stack.distortion = 0.0;
  stack.upper_map = [](const Vector& x) -> Vector {
    const double angle = (x[0] - 0.5) / radius;
    return Vector::Unit(2, 1) * (1.1 + radius) +
           (radius + x[1] - 2.0 * x[1]) * (Vector(2) << std::sin(angle), -std::cos(angle)).finished();
  };
  return stack;
}

struct Pair {
  explicit Pair(const StackedBoxes& stack) : body(make_meshed_body(make_stack(stack), stack.geometry_degree)) {
    pair.facets = body->mesh.group("lower.y1", 1).members;
    pair.opposite_facets = body->mesh.group("upper.y0", 1).members;
    pair.large_sliding = true;
  }
  [[nodiscard]] NormalVariation variation() const {
    return normal_variation(body->body, pair.facets, pair.opposite_facets);
  }
  std::unique_ptr<MeshedBody> body;
  ContactPair pair;
};

TEST(NormalVariation, OfACircleAboveAPlane) {
  for (const int degree : {1, 2}) {
    for (const auto& [flat, round] : {std::pair{8, 8}, {4, 16}, {24, 8}}) {
      const double h_flat = 1.0 / flat, h_round = 1.0 / round;
      const NormalVariation turns = Pair(round_on_flat(flat, round, degree)).variation();
      ASSERT_TRUE(turns.touch);
      const double window = degree == 1 ? std::max(h_flat, h_round) : h_flat;
      EXPECT_NEAR(turns.own, 2.0 * window / radius, 0.02 * turns.own) << flat << " " << round;
      EXPECT_NEAR(turns.opposite, h_round / radius, 0.02 * turns.opposite) << flat << " " << round;
      EXPECT_NEAR(turns.own_of_bends, turns.own, 1e-12);
    }
  }
}

/// Half of the round side, bounded by the plane of symmetry, at which its normals end.
TEST(NormalVariation, OfAHalfThatEndsAtAPlaneOfSymmetry) {
  StackedBoxes stack = round_on_flat(8, 8, 1);
  const PointMap whole = stack.upper_map;
  stack.upper_map = [whole](const Vector& x) -> Vector {
    return whole((Vector(2) << 0.5 + 0.5 * x[0], x[1]).finished());
  };
  const NormalVariation turns = Pair(stack).variation();
  ASSERT_TRUE(turns.touch);
  EXPECT_NEAR(turns.opposite, 1.0 / (16.0 * radius), 0.02 * turns.opposite);
}

/// The round side carries the multipliers unless its facets are twice as large as the flat ones.
TEST(NormalVariation, ChooseTheRoundSideUpToTwiceTheSize) {
  for (const auto& [flat, round, takes_round] :
       {std::tuple{16, 16, true}, {20, 16, true}, {8, 16, true}, {48, 16, false}}) {
    Pair test(round_on_flat(flat, round, 2));
    EXPECT_EQ(choose_side(test.body->body, test.pair).opposite, takes_round) << flat;
    std::swap(test.pair.facets, test.pair.opposite_facets);
    EXPECT_EQ(choose_side(test.body->body, test.pair).opposite, !takes_round) << flat;
  }
}

TEST(NormalVariation, DoubtASideWhoseFacetsSpanALargeTurn) {
  Pair test(round_on_flat(3, 3, 2));
  const std::optional<SideDoubt> flat = doubt_side(test.body->body, test.pair);
  ASSERT_TRUE(flat);
  EXPECT_TRUE(flat->other_is_better);
  EXPECT_NEAR(flat->variation, 2.0 / (3.0 * radius), 0.02);
  EXPECT_NEAR(flat->other_variation, 1.0 / (3.0 * radius), 0.01);
  EXPECT_EQ(flat->finer, 1.0);
  std::swap(test.pair.facets, test.pair.opposite_facets);
  EXPECT_FALSE(doubt_side(test.body->body, test.pair));
  test.pair.tied = true;
  std::swap(test.pair.facets, test.pair.opposite_facets);
  EXPECT_FALSE(doubt_side(test.body->body, test.pair)) << "glued surfaces do not touch elsewhere";
}

/// Faces that lie on each other have one direction, whatever their edges are.
TEST(NormalVariation, HaveNoDoubtOfFlatFaces) {
  StackedBoxes stack;
  stack.lower_counts = {4, 2};
  stack.upper_counts = {3, 2};
  stack.distortion = 0.0;
  const Pair test(stack);
  EXPECT_TRUE(test.variation().touch);
  EXPECT_EQ(test.variation().own_of_bends, 0.0);
  EXPECT_FALSE(doubt_side(test.body->body, test.pair));
}

/// Two flat faces at an angle do not touch in their interiors.
TEST(NormalVariation, AreNoneOfFacesThatDoNotLookAtEachOther) {
  StackedBoxes stack;
  stack.lower_counts = stack.upper_counts = {3, 2};
  stack.distortion = 0.0;
  stack.upper_map = [](const Vector& x) -> Vector { return Vector(x + Vector::Unit(2, 1) * (1.0 + 0.1 * x[0])); };
  EXPECT_FALSE(Pair(stack).variation().touch);
}

/// A flat face reaches the rim of a hollow, but not its interior.
TEST(NormalVariation, AreNoneInAHollowThatAFlatFaceDoesNotReach) {
  StackedBoxes stack = round_on_flat(6, 8, 1);
  stack.upper_map = [](const Vector& x) -> Vector {
    const double side = x[0] - 0.5;
    return Vector(x + Vector::Unit(2, 1) * (1.1 - (1.0 - x[1]) * side * side));
  };
  EXPECT_FALSE(Pair(stack).variation().touch);
}

}  // namespace
}  // namespace ricochet::test_support
