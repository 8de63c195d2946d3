#include "ricochet/problem/contact_couples.hpp"

#include <gtest/gtest.h>

#include "support/case_run.hpp"
#include "support/two_bodies.hpp"

namespace ricochet::test_support {
namespace {

/// A box that has slid along a larger one and turned a little, with contact at its base.
std::string sled(const std::string& supports) {
  StackedBoxes boxes;
  boxes.lower_counts = {5, 2};
  boxes.upper_counts = {3, 2};
  boxes.upper_map = affine_map(0.4 * Matrix::Identity(2, 2), Eigen::Vector2d(0.3, 1.01));
  return "[mesh]\nfile = \"" + write_mesh("couples.msh", make_stack(boxes)) +
         "\"\n[[material]]\ngroup = \"all\"\nlaw = \"neo-hookean\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n"
         "[[contact]]\ngroup = \"upper.y0\"\nagainst = \"lower.y1\"\nsliding = \"large\"\n" +
         supports + "[time]\nstep = 1e-3\nend = 1e-3\n";
}

/// Couples of unit reactions on rows of a step, about the positions at its end.
Vector couples(const std::string& supports) {
  const CaseRun run(sled(supports));
  const SemidiscreteProblem& problem = run.problem();
  ContactCouples all(problem);
  const Vector start = Vector::Zero(problem.dof_count());
  Vector end = start;
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    if (problem.nodes(1, node) < 1.005) continue;
    end[2 * node] = 0.1 - 0.2 * (problem.nodes(1, node) - 1.01);
    end[2 * node + 1] = 0.2 * (problem.nodes(0, node) - 0.3) - 0.01;
  }
  ContactRows rows = *problem.contact.rows;
  const StepStart from{start, 0.0};
  problem.contact.geometry->update(end, 1e-3, &from, rows);
  Vector force = start;
  all.add(end, rows, Vector::Ones(rows.size()), {}, force);
  return force;
}

TEST(ContactCouples, ActOnBodiesThatMoveFreelyAlone) {
  const Vector free = couples("");
  EXPECT_GT(free.lpNorm<Eigen::Infinity>(), 1e-3);
  EXPECT_TRUE(couples("[[support]]\ngroup = \"lower.y0\"\ncomponents = [\"y\"]\n").isZero(0.0));
  EXPECT_TRUE(couples("[[support]]\ngroup = \"upper.y1\"\ncomponents = [\"x\"]\n").isZero(0.0));
}

}  // namespace
}  // namespace ricochet::test_support
