#include "ricochet/contact/mortar/corner_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/case_run.hpp"

namespace ricochet::test_support {
namespace {

/// A block with an L-shaped top, and a disc above it.
CaseRun block_and_disc(const std::string& sliding) {
  const std::string mesh = mesh_geometry(
      "corner-pairs",
      "Point(1) = {0, 0, 0};\nPoint(2) = {2, 0, 0};\nPoint(3) = {2, 1, 0};\nPoint(4) = {1, 1, 0};\nPoint(5) = {1, 2, "
      "0};\nPoint(6) = {0, 2, 0};\nFor i In {1:6}\nLine(i) = {i, (i % 6) + 1};\nEndFor\nCurve Loop(1) = {1:6};\nPlane "
      "Surface(1) = {1};\nDisk(2) = {1.5, 3, 0, 0.4, 0.4};\nPhysical Surface(\"block\") = {1};\nPhysical "
      "Surface(\"disc\") = {2};\nPhysical Curve(\"steps\") = {2:5};\nPhysical Curve(\"rim\") = {7};\n",
      0.2, 1);
  return CaseRun("[mesh]\nfile = \"" + mesh +
                 "\"\n[[material]]\ngroup = [\"block\", \"disc\"]\ndensity = 1.0\nyoung = 1.0\npoisson = 0.3\n"
                 "[[contact]]\ngroup = \"rim\"\nagainst = \"steps\"\nmultipliers_on = \"group\"\n" +
                 sliding + "[time]\nstep = 1e-3\nend = 1e-3\n");
}

/// The ends of the surface, where it has one facet, are rims and no corners; the inner edge is concave.
TEST(CornerPairs, HaveTheConvexCornersOfTheOtherSide) {
  const CaseRun run = block_and_disc("sliding = \"large\"\n");
  const std::vector<ContactPair>& pairs = run.model().contact_pairs;
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_FALSE(pairs[0].at_corners);
  EXPECT_TRUE(pairs[1].at_corners);
  EXPECT_NE(pairs[1].exchanged, pairs[0].exchanged);
  const std::vector<Index> corners = convex_corners(run.model().body, pairs[1].facets);
  ASSERT_EQ(corners.size(), 2U);
  for (const Index node : corners) {
    const Vector at = run.problem().nodes.col(node);
    EXPECT_TRUE(at.isApprox((Vector(2) << 2.0, 1.0).finished()) || at.isApprox((Vector(2) << 1.0, 2.0).finished()));
  }
  EXPECT_TRUE(convex_corners(run.model().body, pairs[0].facets).empty());
  const ContactBoundary& contact = run.problem().contact;
  EXPECT_EQ(std::ranges::count(contact.pair, 1), 2);
}

TEST(CornerPairs, BelongToPairsThatSlideFar) {
  EXPECT_EQ(block_and_disc("pair_at = [0.0, -0.6]\n").model().contact_pairs.size(), 1U);
}

}  // namespace
}  // namespace ricochet::test_support
