#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "ricochet/base/log.hpp"
#include "ricochet/mesh/merge_parts.hpp"
#include "support/case_run.hpp"
#include "support/errors.hpp"
#include "support/two_bodies.hpp"

/// @file Pairs of bodies named in a case file: refused pairs, and multipliers on either side.
namespace ricochet::test_support::body_pairs_test {

/// Two blocks of triangles, the upper one `lift` above the lower one; `bulge` rounds both surfaces.
std::string write_blocks(int refinement, double lift, double bulge = 0.0) {
  StackedBoxes stack;
  stack.lower_counts = {5 * refinement, 4 * refinement};
  stack.upper_counts = {7 * refinement, 4 * refinement};
  const auto rounded = [bulge](double x) { return bulge * (std::cos(2.0 * (x - 0.5)) - 1.0); };
  stack.lower_map = [rounded](const Vector& x) { return Vector(Eigen::Vector2d(x[0], x[1] * (1.0 + rounded(x[0])))); };
  stack.upper_map = [=](const Vector& x) {
    return Vector(Eigen::Vector2d(x[0], 1.0 + lift + x[1] - (1.0 - x[1]) * rounded(x[0])));
  };
  return write_mesh(fmt::format("pairs{}_{}_{}.msh", refinement, lift, bulge), make_stack(stack));
}

std::string case_of(const std::string& mesh, const std::string& contacts, const std::string& end = "0.02") {
  return "[mesh]\nfile = \"" + mesh + "\"\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nlambda = 30.0\nmu = 20.0\n" +
         contacts + "[[motion]]\ngroup = \"upper.body\"\nvelocity = [0.0, -0.5]\n[time]\nstep = 0.01\nend = " + end +
         "\n";
}

std::string pair_of(const std::string& group, const std::string& against, const std::string& more = "") {
  return "[[contact]]\ngroup = \"" + group + "\"\nagainst = \"" + against + "\"\n" + more;
}

void expect_refusal(const std::string& toml, const std::vector<std::string>& parts) {
  expect_error(parts, [&] { const CaseRun run(toml); });
}

TEST(BodyPairs, RefuseBodiesThatOverlap) {
  const std::string overlap = write_blocks(1, -0.05);
  expect_refusal(case_of(overlap, pair_of("upper.y0", "lower.y1")),
                 {"overlap at the start", "the deepest by 0.05 at ("});
  // Closed gaps and a press fit are intended.
  const CaseRun closed(case_of(overlap, pair_of("upper.y0", "lower.y1", "initial_gap = \"closed\"\n")));
  EXPECT_EQ(closed.problem().contact.initial_gap.minCoeff(), 0.0);
  Vector gaps;  // of the nodes of both bodies
  closed.problem().node_gaps(Vector::Zero(closed.problem().dof_count()), 0.0, gaps);
  EXPECT_GT(gaps.size(), closed.problem().contact.initial_gap.size());
  EXPECT_EQ(gaps.minCoeff(), 0.0);
  // Pairs that slide far have points on one side.
  const CaseRun sliding(
      case_of(overlap, pair_of("upper.y0", "lower.y1", "initial_gap = \"closed\"\nsliding = \"large\"\n")));
  EXPECT_GT(sliding.model().pair_facings.at(0).closed, 0);
  EXPECT_EQ(StepEnd(sliding).gap.minCoeff(), 0.0);
}

/// pair_at moves the body of `group` 0.05 too far, whichever side carries the multipliers.
TEST(BodyPairs, WarnOfBodiesThatOverlapWherePaired) {
  const std::string mesh = write_blocks(1, 0.2);
  for (const std::string side : {"group", "against"}) {
    const auto warnings = [&](const std::string& more) {
      const log::Silence silence;
      const CaseRun run(case_of(mesh, pair_of("upper.y0", "lower.y1", "multipliers_on = \"" + side + "\"\n" + more)));
      return run.session().warnings();
    };
    EXPECT_TRUE(warnings("pair_at = [0.0, -0.2]\n").empty()) << side;
    EXPECT_TRUE(warnings("pair_at = [0.0, -0.15]\n").empty()) << side;
    EXPECT_TRUE(warnings("pair_at = [0.0, -0.25]\ninitial_gap = \"closed\"\n").empty()) << side;
    const std::vector<std::string> told = warnings("pair_at = [0.0, -0.25]\n");
    ASSERT_EQ(told.size(), 1U) << side;
    for (const std::string part : {"overlap at the displacement pair_at", "the deepest by 0.05 at ("})
      EXPECT_TRUE(has(told[0], part));
  }
}

TEST(BodyPairs, RefuseGroupsThatNeverFaceEachOther) {
  const std::string mesh = write_blocks(1, 0.1);
  expect_refusal(case_of(mesh, pair_of("upper.y1", "lower.y1")), {"do not face each other", "pair_at"});
  expect_refusal(case_of(mesh, pair_of("upper.y1", "lower.y0", "tied = true\n")), {"cannot be tied"});
}

TEST(BodyPairs, RefuseTheSameFacetsOnBothSides) {
  const std::string mesh = write_blocks(1, 0.1);
  expect_refusal(case_of(mesh, pair_of("upper.y0", "upper.y0")), {"\"upper.y0\", the group itself"});
  expect_refusal(case_of(mesh, pair_of("upper.y0", "boundary")), {"share 7 facets", "cannot be on both sides"});
}

/// A body between two others: its one side cannot follow both of them.
TEST(BodyPairs, RefuseNodesThatAreTiedTwice) {
  const auto block = [](double x, double y, std::vector<int> counts) {
    return make_box_mesh({CellShape::triangle, std::move(counts), 1, 0.0,
                          [=](const Vector& p) { return Vector(Eigen::Vector2d(x + p[0], y + p[1])); }});
  };
  const std::string mesh = write_mesh("tied_twice.msh", merge_parts({{"upper", block(0.0, 1.0, {7, 4})},
                                                                     {"lower", block(0.0, 0.0, {5, 4})},
                                                                     {"other", block(0.0, 0.0, {3, 4})}}));
  const std::string tied = "tied = true\nmultipliers_on = \"group\"\n";
  expect_refusal(case_of(mesh, pair_of("upper.y0", "lower.y1", tied) + pair_of("upper.y0", "other.y1", tied)),
                 {"are already tied by contact 0", "cannot follow two surfaces"});
}

TEST(BodyPairs, RefuseSurfacesTooFarApartToBeTied) {
  expect_refusal(case_of(write_blocks(1, 0.3), pair_of("upper.y0", "lower.y1", "tied = true\n")), {"too far apart"});
}

/// Impulse on the upper body.
double impulse(int refinement, const std::string& side) {
  CaseRun run(case_of(write_blocks(refinement, 0.02, 0.1),
                      pair_of("upper.y0", "lower.y1", "multipliers_on = \"" + side + "\"\n"), "1.5"));
  const auto momentum = [&] {
    const SemidiscreteProblem& problem = run.problem();
    Vector motion;
    problem.mass.multiply(run.state().velocity, motion);
    double sum = 0.0;
    for (Index node = 0; node < problem.nodes.cols(); ++node) {
      if (problem.nodes(1, node) > 1.0) sum += motion[2 * node + 1];
    }
    return sum;
  };
  const double before = momentum();
  run.run([] {}, false);
  return momentum() - before;
}

/// The side of the multipliers is a choice of the discretization: its influence decreases as the error does.
TEST(BodyPairs, ExchangeSidesWithinTheDiscretizationError) {
  std::vector<double> difference, error;
  const double exact = impulse(6, "group");
  EXPECT_GT(exact, 0.3) << "the bodies met and parted";
  for (const int refinement : {1, 2, 4}) {
    const double one = impulse(refinement, "group"), other = impulse(refinement, "against");
    difference.push_back(std::abs(one - other));
    error.push_back(std::max(std::abs(one - exact), std::abs(other - exact)));
    EXPECT_GT(difference.back(), 0.0);
    EXPECT_LT(difference.back(), 2.0 * error.back());
  }
  EXPECT_LT(difference[0], 0.02 * exact);
  EXPECT_LT(difference[2], 0.25 * difference[0]);
}

}  // namespace ricochet::test_support::body_pairs_test
