#include <gtest/gtest.h>

#include <algorithm>

#include "support/case_run.hpp"
#include "support/same_snapshots.hpp"
#include "support/two_bodies.hpp"

// A block that is drawn along a slab ten times its length: contact is condensed on the dofs that the points reach, and
// those that they have left behind are given up.

namespace ricochet::test_support {
namespace {

std::string drawn_block() {
  StackedBoxes boxes;
  boxes.lower_shape = boxes.upper_shape = CellShape::quadrilateral;
  boxes.lower_counts = {96, 2};
  boxes.upper_counts = {4, 2};
  boxes.distortion = 0.0;
  boxes.lower_map = affine_map(Eigen::Vector2d(12.0, 0.5).asDiagonal().toDenseMatrix(), Eigen::Vector2d::Zero());
  boxes.upper_map =
      affine_map(Eigen::Vector2d(1.0, 0.5).asDiagonal().toDenseMatrix(), Eigen::Vector2d(0.5, 0.5 + 1e-6));
  std::string text = "[mesh]\nfile = \"" + write_mesh("long_slab.msh", make_stack(boxes)) + "\"\n";
  for (const std::string body : {"lower", "upper"})
    text += "[[material]]\ngroup = \"" + body +
            ".body\"\nlaw = \"neo-hookean\"\nyoung = 1e4\npoisson = 0.3\ndensity = 1.0\n";
  return text +
         "[[support]]\ngroup = \"lower.y0\"\ncomponents = [\"x\", \"y\"]\n"
         "[[support]]\ngroup = \"upper.y1\"\ncomponents = [\"y\"]\nvalue = \"-0.01*min(t/0.1,1)\"\n"
         "[[support]]\ngroup = \"upper.y1\"\ncomponents = [\"x\"]\nvalue = \"10*max(t-0.1,0)\"\n"
         "[[contact]]\ngroup = \"upper.y0\"\nagainst = \"lower.y1\"\nsliding = \"large\"\nfriction = 0.2\n"
         "[time]\nstep = 0.01\nend = 1.1\n";
}

/// Largest number of dofs on which a stage of the snapshot condenses its contact.
std::size_t condensed_dofs(const Snapshot& snapshot) {
  std::size_t most = 0;
  for (const auto& [name, value] : snapshot.values()) {
    const auto* const numbers = std::get_if<std::vector<std::int64_t>>(&value);
    if (name.ends_with(".dofs") && numbers != nullptr) most = std::max(most, numbers->size());
  }
  return most;
}

TEST(LongSlide, CondensesContactOnTheDofsThatPointsReachAndResumesWithTheSameBits) {
  CaseRun run(drawn_block());
  std::vector<Snapshot> snapshots;
  std::vector<std::size_t> dofs;
  double force = 0.0;
  run.run([&] {
    if (run.state().step % 10 == 5) snapshots.push_back(snapshot_of(run.simulation()));
    dofs.push_back(condensed_dofs(snapshot_of(run.simulation())));
    const double now = run.state().forces.normal_reaction.sum();
    force = run.state().step == 20 ? now : std::min(force, now);
  });
  ASSERT_GT(force, 20.0) << "in all steps from 20 on";
  // The slab has 194 dofs on its surface, of which the block faces 9 or 10 nodes.
  EXPECT_GT(dofs.back(), 20U);
  EXPECT_LE(*std::ranges::max_element(dofs), 130U);
  EXPECT_NE(std::ranges::adjacent_find(dofs, std::greater<>()), dofs.end()) << "none was given up";
  const Snapshot end = snapshot_of(run.simulation());
  for (std::size_t i = 0; i < snapshots.size(); i += 2) {
    const std::unique_ptr<Scheme> scheme = make_scheme(run.input().time);
    Simulation resumed(run.problem(), *scheme, snapshots[i], step_solver_options(run.input()),
                       step_control_options(run.input().time));
    expect_same(snapshots[i], snapshot_of(resumed));
    while (resumed.state().step < run.state().step) resumed.advance();
    expect_same(end, snapshot_of(resumed));
  }
}

}  // namespace
}  // namespace ricochet::test_support
