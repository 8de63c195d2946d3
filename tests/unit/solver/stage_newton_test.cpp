#include "ricochet/solver/stage_newton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/case_run.hpp"

namespace ricochet::test_support {
namespace {

/// A block above another one, with contact that follows the motion.
CaseRun sliding_blocks() {
  const std::string mesh = mesh_geometry(
      "sliding-blocks",
      "Rectangle(1) = {0, 0, 0, 1, 1};\nRectangle(2) = {0.3, 1.01, 0, 0.4, 0.4};\nPhysical Surface(\"lower\") = {1};\n"
      "Physical Surface(\"upper\") = {2};\nPhysical Curve(\"top\") = {3};\nPhysical Curve(\"bottom\") = {5};\n",
      0.5, 1);
  return CaseRun("[mesh]\nfile = \"" + mesh +
                 "\"\n[[material]]\ngroup = [\"lower\", \"upper\"]\ndensity = 1.0\nyoung = 1.0\npoisson = 0.3\nlaw = "
                 "\"neo-hookean\"\n[[contact]]\ngroup = \"bottom\"\nagainst = \"top\"\nsliding = \"large\"\n"
                 "[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 1e-3\nend = 1e-3\n");
}

/// The operator is M, so that the residual of an iteration is −M δ. Corrections that grow are accelerated: δ does not
/// change by them alone. Frozen rows are another problem, whose first correction is added as it is.
TEST(StageNewton, AcceleratesAnewWithRowsThatFreeze) {
  const CaseRun run = sliding_blocks();
  const SemidiscreteProblem& problem = run.problem();
  const ContactGeometry& geometry = *problem.contact.geometry;
  const Index size = problem.dof_count();
  Stage stage;
  stage.rows = problem.contact.rows;
  stage.linearization.displacement = Vector::Zero(size);
  stage.right_hand_side.force = Vector::Zero(size);
  stage.right_hand_side.prescribed = Vector(problem.supports.size());
  stage.conditions.gap.offset = Vector::Zero(problem.contact.size());
  constexpr int frozen_round = 6, last_round = 8;
  std::vector<Vector> residuals, corrections;
  const auto solve_linear = [&](Stage& linear, StageSolution& solution) {
    const int round = int(residuals.size());
    if (round == frozen_round) {
      const Vector start = Vector::Zero(size);
      const StepStart of_step{start, 0.0};
      ContactRows rows = *problem.contact.rows;
      geometry.begin_step();
      geometry.update(start, 0.0, &of_step, rows);
      ASSERT_TRUE(geometry.freeze());
    }
    residuals.push_back(linear.right_hand_side.force);
    solution.increment.setZero(size);
    if (round < last_round) {
      for (Index i = 0; i < size; ++i)
        solution.increment[i] = 1e-3 * std::pow(1.1, round) * std::sin(double((round + 1) * (i + 1)));
    }
    corrections.push_back(solution.increment);
  };
  StageSolution solution;
  StageNewton(problem).solve(
      {.mass = 1.0, .stiffness = 0.0, .damping = 0.0}, 10.0, solve_linear, [](const Vector&) {}, stage, solution);
  geometry.end_step();
  const auto distance_from_plain = [&](int round) {
    const auto k = std::size_t(round);
    Vector of_correction;
    problem.mass.multiply(corrections[k], of_correction);
    return (residuals[k + 1] - residuals[k] + of_correction).norm() / of_correction.norm();
  };
  EXPECT_GT(distance_from_plain(frozen_round - 1), 0.1);
  EXPECT_LT(distance_from_plain(frozen_round), 1e-12);
  EXPECT_GT(distance_from_plain(frozen_round + 1), 0.1);
}

}  // namespace
}  // namespace ricochet::test_support
