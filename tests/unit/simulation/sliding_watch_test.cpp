#include "ricochet/simulation/monitor/sliding_watch.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/log.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/simulation/monitor/penetration_watch.hpp"
#include "support/case_run.hpp"
#include "support/two_bodies.hpp"

// A square of 4 × 4 cells on another one of 2 × 2, moved as a rigid body: its position determines its slip and its
// depth.

namespace ricochet::test_support {
namespace {

/// Distance of the two meshes: nodes of one file must not coincide.
constexpr double gap = 1e-3;

std::string stack(const std::string& contact) {
  StackedBoxes boxes;
  boxes.lower_shape = boxes.upper_shape = CellShape::quadrilateral;
  boxes.lower_counts = {2, 2};
  boxes.upper_counts = {4, 4};
  boxes.distortion = 0.0;
  boxes.upper_map = affine_map(Matrix::Identity(2, 2), Eigen::Vector2d(0.0, 1.0 + gap));
  const std::string mesh = write_mesh("stacked_boxes.msh", make_stack(boxes));
  std::string text = "[mesh]\nfile = \"" + mesh + "\"\n";
  for (const std::string body : {"lower", "upper"})
    text += "[[material]]\ngroup = \"" + body + ".body\"\nyoung = 1.0\npoisson = 0.0\ndensity = 1.0\n";
  return text + contact + "[time]\nstep = 0.01\nend = 0.1\n";
}

const std::string lower_on_upper = "[[contact]]\ngroup = \"lower.y1\"\nagainst = \"upper.y0\"\n";

/// State of a run with the upper square displaced from its contact position, all points pressed or none.
State displaced(const CaseRun& run, double x, double y, bool pressed, double time) {
  State state = run.state();
  const ConnectedBodies bodies = find_connected_bodies(run.model().space);
  for (std::size_t node = 0; node < bodies.of_node.size(); ++node) {
    if (bodies.of_node[node] == 1) state.displacement.segment<2>(2 * Index(node)) << x, y - gap;
  }
  state.forces.normal_reaction.setConstant(run.problem().contact.size(), pressed ? 1.0 : 0.0);
  state.time = time;
  return state;
}

TEST(SlidingWatch, TellsOnceWhatSlidesByMoreThanHalfOfTheSmallerFacet) {
  const CaseRun run(stack(lower_on_upper));
  SlidingWatch watch(run.model().body, run.problem(), run.model().contact_pairs);
  std::vector<std::string> told;
  const log::CollectWarnings collecting(told);
  const log::Silence silence;
  watch.check(displaced(run, 0.3, 0.0, false, 0.25));
  ASSERT_EQ(watch.report().size(), 1U);
  EXPECT_EQ(watch.report()[0].slip, 0.0) << "open points may slide";
  watch.check(displaced(run, 0.124, 0.0, true, 0.5));
  EXPECT_NEAR(watch.report()[0].slip, 0.124, 1e-12);
  EXPECT_NEAR(watch.report()[0].limit, 0.125, 1e-12) << "facets of 1/2 and 1/4";
  EXPECT_FALSE(watch.report()[0].is_beyond());
  EXPECT_TRUE(told.empty());
  watch.check(displaced(run, 0.126, -0.01, true, 0.75));
  watch.check(displaced(run, -0.2, 0.0, true, 1.0));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].find("\"lower.y1\" and \"upper.y0\""), std::string::npos) << told[0];
  EXPECT_NE(told[0].find("at t = 0.75"), std::string::npos) << told[0];
  EXPECT_TRUE(watch.report()[0].is_beyond());
  EXPECT_NEAR(watch.report()[0].slip, 0.2, 1e-12);
  EXPECT_EQ(watch.report()[0].time, 1.0);
  EXPECT_EQ(watch.report()[0].time_beyond, 0.75);
  ASSERT_EQ(watch.report()[0].position.size(), 2U);
  EXPECT_NEAR(watch.report()[0].position[1], 1.0 + gap, 1e-12) << "of the finer side";
  // A resumed run keeps the slip, and does not report it again.
  Snapshot snapshot;
  watch.persist(snapshot.saver("sliding"));
  SlidingWatch resumed(run.model().body, run.problem(), run.model().contact_pairs);
  resumed.persist(snapshot.loader("sliding"));
  resumed.check(displaced(run, 0.15, 0.0, true, 1.25));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(resumed.report()[0].time_beyond, 0.75);
  EXPECT_NEAR(resumed.report()[0].slip, 0.2, 1e-12);
}

TEST(SlidingWatch, TakesTheSmallerFacetsOfEitherSide) {
  for (const std::string side : {"group", "against"}) {
    const CaseRun run(stack(lower_on_upper + "multipliers_on = \"" + side + "\"\n"));
    SlidingWatch watch(run.model().body, run.problem(), run.model().contact_pairs);
    watch.check(displaced(run, 0.1, 0.0, true, 0.5));
    ASSERT_EQ(watch.report().size(), 1U);
    EXPECT_NEAR(watch.report()[0].limit, 0.125, 1e-12) << side << ": facets of 1/2 and 1/4";
  }
}

/// Slip is measured from the position at which facets were paired, that of the body of the case's `group`.
TEST(SlidingWatch, BeginsAtPairAt) {
  for (const std::string side : {"group", "against"}) {
    const CaseRun run(stack(lower_on_upper + "pair_at = [-0.1, 0.0]\nmultipliers_on = \"" + side + "\"\n"));
    SlidingWatch watch(run.model().body, run.problem(), run.model().contact_pairs);
    watch.check(displaced(run, 0.1, 0.0, true, 0.5));
    EXPECT_NEAR(watch.report()[0].slip, 0.0, 1e-12) << side;
    watch.check(displaced(run, 0.0, 0.0, true, 0.5));
    EXPECT_NEAR(watch.report()[0].slip, 0.1, 1e-12) << side;
  }
}

/// The contact itself measures the depth of its nodes: its gaps are in the history (max_penetration).
TEST(PenetrationWatch, LeavesNodesOfAContactToItsGaps) {
  const CaseRun run(stack(lower_on_upper));
  PenetrationWatch watch(run.model().body, run.problem(), run.model().contact_pairs, {});
  for (const double depth : {0.0, 0.2, 0.3}) watch.check_end(displaced(run, 0.0, -depth, true, depth));
  EXPECT_TRUE(watch.report().found.empty());
}

/// The sides of the upper square are in no contact, so they may penetrate.
TEST(PenetrationWatch, LooksAtAllOtherNodesOfTwoBodiesInContact) {
  const CaseRun run(stack(lower_on_upper));
  PenetrationWatch watch(run.model().body, run.problem(), run.model().contact_pairs, {});
  watch.check_end(displaced(run, 0.9, -0.3, true, 0.5));
  ASSERT_EQ(watch.report().found.size(), 1U);
  EXPECT_TRUE(watch.report().found[0].contact.empty());
  EXPECT_NEAR(watch.report().found[0].depth, 0.05, 1e-12) << "the second node of a side, 1/4 above the corner";
}

}  // namespace
}  // namespace ricochet::test_support
