#include <gtest/gtest.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>

#include "ricochet/simulation/simulation.hpp"
#include "support/case_run.hpp"

/// @file Bodies whose nodes may each meet any of several planes: a floor and a ceiling, three walls, wedges.

namespace ricochet::test_support::several_planes_test {

/// A block of 4 × 4 squares with all sides as contact boundary.
std::string block_mesh(const std::string& motion = "") {
  return mesh_geometry("block",
                       "Rectangle(1)={0,0,0,1,1}; Transfinite Curve{1:4}=5; Transfinite Surface{1}; " + motion +
                           "Recombine Surface{1}; Physical Surface(\"body\")={1}; Physical Curve(\"sides\")={1:4};",
                       1.0, 1);
}

struct Wall {
  std::string name;
  std::vector<double> point, normal;
};

std::string list(const std::vector<double>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

std::string walled_case(const std::string& mesh, const std::vector<Wall>& walls, const std::vector<double>& velocity,
                        double friction, const std::string& time, const std::string& mass = "equivalent",
                        const std::string& load = "") {
  std::string text = "[mesh]\nfile = \"" + mesh +
                     "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nlambda = 60.0\nmu = 40.0\n" + load +
                     "[initial]\nvelocity = " + list(velocity) + "\n[mass]\ntype = \"" + mass + "\"\n[time]\n" + time;
  for (const Wall& wall : walls) {
    text += fmt::format(
        "[obstacle.{0}]\ntype = \"plane\"\npoint = {1}\nnormal = {2}\n"
        "[[contact]]\ngroup = \"sides\"\nobstacle = \"{0}\"\nfriction = {3}\n",
        wall.name, list(wall.point), list(wall.normal), friction);
  }
  return text;
}

const std::string trapezoidal = "scheme = \"newmark\"\npreset = \"trapezoidal\"\n";

/// Runs to the end. In every step all nodes are outside of all walls, and without friction energy changes by the
/// scheme's identity (see energy_identities_test.cpp). Every wall is hit.
void expect_bounces(CaseRun& run, std::size_t walls, bool frictionless = true) {
  std::vector<double> impulse(walls, 0.0);
  StepEnd before(run);
  double worst = 0.0, deepest = 0.0;
  run.run(
      [&] {
        const StepEnd after(run);
        const double size = std::max(before.size_of_energy_terms, after.size_of_energy_terms);
        const double work = 0.5 * (before.normal.dot(after.gap) - after.normal.dot(before.gap));
        worst = std::max(worst, std::abs(after.energy - before.energy - work) / size);
        deepest = std::max(deepest, -after.gap.minCoeff());
        for (Index i = 0; i < after.normal.size(); ++i)
          impulse[std::size_t(run.problem().contact.pair[std::size_t(i)])] += after.normal[i];
        before = after;
      },
      false);
  EXPECT_LT(frictionless ? worst : 0.0, 20.0 * std::numeric_limits<double>::epsilon());
  EXPECT_LT(deepest, 1e-13);
  for (const double sum : impulse) EXPECT_GT(sum, 0.0);
}

const std::vector<Wall> floor_and_ceiling{{"floor", {0.0, -0.1}, {0.0, 1.0}}, {"ceiling", {0.0, 1.15}, {0.0, -1.0}}};

TEST(SeveralPlanes, ABlockBouncesBetweenFloorAndCeiling) {
  CaseRun run(walled_case(block_mesh(), floor_and_ceiling, {0.0, -1.0}, 0.0, trapezoidal + "step = 2e-3\nend = 1.0\n"));
  expect_bounces(run, 2);
  // Mirrored at x = 1/2, up to rounding that grows with the number of impacts.
  const Points& nodes = run.problem().nodes;
  const Vector& u = run.state().displacement;
  for (Index i = 0; i < nodes.cols(); ++i) {
    const Vector at = Eigen::Vector2d(1.0 - nodes(0, i), nodes(1, i));
    Index j = 0;
    (nodes.colwise() - at).colwise().norm().minCoeff(&j);
    EXPECT_NEAR(u[2 * i], -u[2 * j], 1e-9);
    EXPECT_NEAR(u[2 * i + 1], u[2 * j + 1], 1e-9);
  }
}

/// The floor's bounce mirrors the ceiling's.
TEST(SeveralPlanes, FloorAndCeilingAreAlike) {
  for (const double friction : {0.0, 0.3}) {
    const std::vector<Wall> same_distance{{"floor", {0.0, -0.1}, {0.0, 1.0}}, {"ceiling", {0.0, 1.1}, {0.0, -1.0}}};
    const std::string time = trapezoidal + "step = 2e-3\nend = 1.0\n";
    CaseRun down(walled_case(block_mesh(), same_distance, {0.2, -1.0}, friction, time));
    CaseRun up(walled_case(block_mesh(), same_distance, {-0.2, 1.0}, friction, time));
    expect_bounces(down, 2, friction == 0.0);
    expect_bounces(up, 2, friction == 0.0);
    const Points& nodes = down.problem().nodes;
    for (Index i = 0; i < nodes.cols(); ++i) {
      const Vector at = Eigen::Vector2d(1.0, 1.0) - nodes.col(i);
      Index j = 0;
      (nodes.colwise() - at).colwise().norm().minCoeff(&j);
      EXPECT_LT((down.state().displacement.segment(2 * i, 2) + up.state().displacement.segment(2 * j, 2)).norm(), 1e-9);
    }
  }
}

TEST(SeveralPlanes, ABlockInThreeWallsHitsAllOfThem) {
  const std::vector<Wall> walls{
      {"left", {-0.1, 0.0}, {1.0, 0.0}}, {"floor", {0.0, -0.1}, {0.0, 1.0}}, {"right", {1.2, 0.0}, {-1.0, 0.0}}};
  for (const double friction : {0.0, 0.3}) {
    CaseRun run(walled_case(block_mesh(), walls, {-0.9, -0.4}, friction, trapezoidal + "step = 2e-3\nend = 1.6\n",
                            "lumped", "[load]\ngravity = [0.0, -1.0]\n"));
    expect_bounces(run, 3, friction == 0.0);
  }
}

/// A corner falls into a wedge; a third plane through its edge adds no constraint to the other two.
TEST(SeveralPlanes, APlaneThroughTheEdgeOfAWedgeChangesNothing) {
  // Edge of the wedge, reached by the corner of the block, which is rotated by 45 degrees about the origin.
  const std::string mesh = block_mesh("Rotate{{0,0,1},{0,0,0},Pi/4}{Surface{1};} ");
  const std::vector<Wall> two{{"one", {0.0, -0.1}, {1.0, 2.0}}, {"other", {0.0, -0.1}, {-1.0, 2.0}}};
  std::vector<Wall> three = two;
  three.push_back({"third", {0.0, -0.1}, {0.0, 1.0}});
  for (const double friction : {0.0, 0.1}) {
    const std::string time = trapezoidal + "step = 2e-3\nend = 0.3\n";
    const std::string load = "[load]\ngravity = [0.2, -1.0]\n";
    CaseRun wedge(walled_case(mesh, two, {0.0, -0.8}, friction, time, "consistent", load));
    CaseRun more(walled_case(mesh, three, {0.0, -0.8}, friction, time, "consistent", load));
    double touched = 0.0;
    wedge.run([&] { touched = std::max(touched, StepEnd(wedge).normal.maxCoeff()); }, false);
    more.run([&] { EXPECT_GE(StepEnd(more).gap.minCoeff(), -1e-13); }, false);
    EXPECT_GT(touched, 0.0);
    if (friction > 0.0) continue;  // the share of three planes in a force, and so their friction, is not determined
    EXPECT_LT((wedge.state().displacement - more.state().displacement).lpNorm<Eigen::Infinity>(), 1e-9);
  }
}

/// A corner of a cube falls into a pyramid of four planes: four conditions on three components.
TEST(SeveralPlanes, ACornerFallsIntoAPyramid) {
  const std::string mesh = mesh_geometry(
      "cube",
      "Box(1)={0,0,0,1,1,1}; Rotate{{1,-1,0},{0,0,0},0.9553166181245093}{Volume{1};} Physical Volume(\"body\")={1}; "
      "Physical Surface(\"sides\")={1:6};",
      0.5, 1);
  std::vector<Wall> walls;
  for (int k = 0; k < 4; ++k) {
    const double angle = 0.3 + k * std::acos(0.0);
    walls.push_back({fmt::format("side{}", k), {0.0, 0.0, -0.05}, {std::cos(angle), std::sin(angle), 1.2}});
  }
  for (const double friction : {0.0, 0.2}) {
    CaseRun run(walled_case(mesh, walls, {0.05, 0.02, -1.0}, friction, trapezoidal + "step = 4e-3\nend = 0.5\n",
                            "consistent", "[load]\ngravity = [0.0, 0.0, -1.0]\n"));
    expect_bounces(run, 4, friction == 0.0);
  }
}

}  // namespace ricochet::test_support::several_planes_test
