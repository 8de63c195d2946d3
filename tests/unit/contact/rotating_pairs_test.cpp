#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "support/case_run.hpp"
#include "support/pair_rows.hpp"
#include "support/two_bodies.hpp"

/// @file Rows of contact between bodies that rotate with them.
namespace ricochet::test_support {
namespace {

using Stack = PairOfBoxes;

CaseRun stack_of(const Stack& of) {
  const bool plane = dimension(of.shape) == 2;
  const std::vector<int> lower = plane ? std::vector{3, 2} : std::vector{3, 2, 2};
  const std::vector<int> upper = plane ? std::vector{4, 2} : std::vector{2, 3, 2};
  const Mesh mesh =
      make_stack({.lower_shape = of.shape, .upper_shape = of.shape, .lower_counts = lower, .upper_counts = upper});
  const std::string name = fmt::format("turning-{}-{}.msh", int(of.shape), of.degree);
  const std::string last = plane ? "y" : "z";
  return CaseRun(fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = {}\n[[material]]\ngroup = \"all\"\ndensity = 1.0\n"
      "young = 100.0\npoisson = 0.3\nlaw = \"neo-hookean\"\n[[contact]]\ngroup = \"upper.{}0\"\nagainst = "
      "\"lower.{}1\"\nmultipliers = \"{}\"\nunstable_multipliers = \"allow\"\nfriction = 0.1\n[time]\nstep = 1e-3\n"
      "end = 1e-3\n",
      write_mesh(name, mesh), of.degree, last, last, of.multipliers));
}

std::vector<Stack> stacks() {
  std::vector<Stack> result;
  for (const CellShape shape : all_cell_shapes()) {
    for (const std::string multipliers : {"p1", "dual", "p0", "nodal"}) result.push_back({shape, multipliers, 1});
    result.push_back({shape, "p1", 2});
  }
  return result;
}

/// A random motion that keeps cells upright: it rotates by 1 and stretches.
Vector some_motion(const SemidiscreteProblem& problem, unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Vector result(problem.dof_count());
  const Index d = problem.dimension;
  Matrix turn = Matrix::Identity(d, d);
  const double c = std::cos(10 * size), s = std::sin(10 * size);
  turn.topLeftCorner(2, 2) << c, -s, s, c;
  if (d == 3) turn = turn * Eigen::AngleAxisd(5 * size, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    for (Index k = 0; k < d; ++k) result[node * d + k] = number(random);
    result.segment(node * d, d) += turn * problem.nodes.col(node) - problem.nodes.col(node);
  }
  return result;
}

/// Rows of all points, as if all were about to touch.
ContactRows rows_of(const SemidiscreteProblem& problem, const Vector& displacement, const StepStart* start) {
  ContactRows rows = *problem.contact.rows;
  rows.gap.setConstant(1e6);  // all gaps have changed by far, so all points are evaluated
  problem.contact.geometry->update(displacement, 0.0, start, rows);
  return rows;
}

TEST(RotatingPairs, RowsAreTheDerivativesOfGaps) {
  for (const Stack& stack : stacks()) {
    const CaseRun run = stack_of(stack);
    const SemidiscreteProblem& problem = run.problem();
    ASSERT_TRUE(problem.contact.follows_motion());
    const Vector at = some_motion(problem, 1, 0.03), direction = some_motion(problem, 2, 0.03);
    const ContactRows rows = rows_of(problem, at, nullptr);
    Vector change;
    rows.normal_motion(direction, change);
    const double h = 1e-5;
    const Vector difference = (gaps(problem, at + h * direction) - gaps(problem, at - h * direction)) / (2.0 * h);
    EXPECT_LT((difference - change).lpNorm<Eigen::Infinity>(), 1e-8) << name_of(stack);
    EXPECT_GT(change.lpNorm<Eigen::Infinity>(), 1e-3);
  }
}

/// The work of normal forces over a step then equals the work along the change of gaps, for any step.
TEST(RotatingPairs, RowsOfAStepMeetBothEnds) {
  for (const Stack& stack : stacks()) {
    const CaseRun run = stack_of(stack);
    const SemidiscreteProblem& problem = run.problem();
    const Vector first = some_motion(problem, 3, 0.02), second = some_motion(problem, 4, 0.04);
    const StepStart start{first, 0.0};
    const ContactRows rows = rows_of(problem, second, &start);
    expect_change_of_gaps(problem, rows, first, second, name_of(stack));
  }
}

TEST(RotatingPairs, RigidMotionsChangeNoGapAndRowsHaveNoResultant) {
  for (const Stack& stack : stacks()) {
    const CaseRun run = stack_of(stack);
    const SemidiscreteProblem& problem = run.problem();
    const Vector at = some_motion(problem, 5, 0.03);
    expect_balance(problem, rows_of(problem, at, nullptr), at, 1e-14, name_of(stack));
    expect_invariant_gaps(problem, at, name_of(stack));
  }
}

}  // namespace
}  // namespace ricochet::test_support
