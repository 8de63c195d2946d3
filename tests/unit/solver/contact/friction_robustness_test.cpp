#include <gtest/gtest.h>

#include <limits>

#include "support/contact_problems.hpp"
#include "support/hard_contact_problems.hpp"

/// @file The Coulomb solver in a time loop, and on operators that are not definite.
namespace ricochet::test_support {
namespace {

/// The next time step of a half-space problem: pressed harder and drawn further.
void advance(FrictionProblem& problem) {
  for (Index i = 0; i < problem.points(); ++i) {
    problem.q[3 * i] -= 0.002;
    problem.q[3 * i + 1] += 0.001;
  }
}

TEST(FrictionInTime, TakesFewNewtonSteps) {
  FrictionProblem problem = half_space_problem(10, 0.3);
  ContactRun solver;
  ContactSolution solution = solver.solve(problem);
  expect_law(problem, solution);
  EXPECT_LE(solution.newton_steps, 15);
  for (int step = 0; step < 10; ++step) {
    advance(problem);
    solution = solver.solve(problem);
    expect_law(problem, solution);
    EXPECT_LE(solution.newton_steps, 4);
    EXPECT_LE((solution.reaction - solve(problem).reaction).lpNorm<Eigen::Infinity>(),
              1e-11 * solution.reaction.lpNorm<Eigen::Infinity>());
  }
  // The same problem again: already solved.
  solution = solver.solve(problem);
  EXPECT_TRUE(solution.solved());
  EXPECT_EQ(solution.newton_steps, 0);
}

TEST(FrictionInTime, NeedsNoFactorAfterASmallChange) {
  FrictionProblem problem = random_problem(40, 2, 0.3, 4);
  ContactRun solver;
  ContactSolution solution = solver.solve(problem);
  problem.q *= 1.0 + 1e-6;
  solution = solver.solve(problem);
  expect_law(problem, solution);
  EXPECT_LE(solution.iterations, 20);
  EXPECT_EQ(solution.factorizations, 0);
}

TEST(FrictionInTime, ResumesFromItsWarmStartWithTheSameBits) {
  for (const Index dimension : {2, 3}) {
    FrictionProblem problem = dimension == 2 ? random_problem(40, 2, 0.3, 4) : half_space_problem(8, 0.3);
    ContactRun solver;
    ContactSolution solution;
    for (int step = 0; step < 3; ++step) {
      solution = solver.solve(problem);
      problem.q *= 1.001;
    }
    ContactRun resumed;
    resumed.start_with(solver.saved());
    ContactSolution other;
    solution = solver.solve(problem);
    other = resumed.solve(problem);
    EXPECT_EQ(other.reaction, solution.reaction);
    EXPECT_EQ(other.iterations, solution.iterations);
  }
}

/// Many unknowns: single-precision factors that last for several steps are part of the resumed state.
TEST(FrictionInTime, ResumesWithTheFactorOfAnEarlierStep) {
  FrictionProblem problem = half_space_problem(14, 0.3);
  ContactRun solver;
  int factorizations = 0;
  for (int step = 0; step < 12; ++step) {
    const ContactSolution solution = solver.solve(problem);
    expect_law(problem, solution);
    factorizations += solution.factorizations;
    if (step >= 3) {
      advance(problem);
      ContactRun resumed;
      resumed.start_with(solver.saved());
      const ContactSolution other = resumed.solve(problem);
      EXPECT_EQ(other.reaction, solver.solve(problem).reaction) << "step " << step;
      EXPECT_EQ(other.iterations, solver.solution().iterations);
    }
    advance(problem);
  }
  EXPECT_GT(factorizations, 0);
}

TEST(FrictionInTime, ForgetsAnotherProblem) {
  const FrictionProblem first = random_problem(30, 3, 0.5, 1);
  const FrictionProblem second = random_problem(30, 3, 0.5, 2);
  ContactRun solver;
  ContactSolution solution;
  solution = solver.solve(first);
  solver.reset();
  solution = solver.solve(second);
  EXPECT_EQ(solution.reaction, solve(second).reaction);
}

/// Every point occurs twice: W has half its rank, u is unchanged.
TEST(FrictionSingular, FindsTheMotionOfPointsThatAreThereTwice) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const double friction : {0.0, 0.3, 1.0}) {
      SCOPED_TRACE(testing::Message() << "F = " << friction << ", " << seed);
      const FrictionProblem single = random_problem(15, 3, friction, seed);
      std::vector<Index> sizes;
      std::vector<Index> rows;
      for (std::size_t i = 0; i + 1 < single.row_offset.size(); ++i) {
        for (int copy = 0; copy < 2; ++copy) {
          sizes.push_back(single.row_offset[i + 1] - single.row_offset[i]);
          for (Index row = single.row_offset[i]; row < single.row_offset[i + 1]; ++row) rows.push_back(row);
        }
      }
      FrictionProblem twice(sizes, friction);
      twice.w = single.w(rows, rows);
      twice.q = single.q(rows);
      const ContactSolution solution = solve(twice);
      expect_law(twice, solution);
      const ContactSolution expected = solve(single);
      const Vector u = twice.q + twice.w * solution.reaction;
      const Vector expected_u = single.q + single.w * expected.reaction;
      EXPECT_LE((u - expected_u(rows)).lpNorm<Eigen::Infinity>(), 1e-11);
    }
  }
}

/// More rows than degrees of freedom, and motions that satisfy all conditions strictly: solutions exist.
TEST(FrictionSingular, SolvesProblemsWithMoreConditionsThanFreedom) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    FrictionProblem problem(std::vector<Index>(12, 3), 0.3);
    Matrix trace(36, 20);
    for (double& value : trace.reshaped()) value = uniform(random);
    problem.w = trace * trace.transpose();
    problem.q = trace * uniform(20, random);
    for (Index i = 0; i < 12; ++i) problem.q[3 * i] += 0.1;
    expect_law(problem, solve(problem), 4e-12);
  }
}

TEST(FrictionFailure, IsSaid) {
  constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const auto expect_unsolved = [](const FrictionProblem& problem) {
    const ContactSolution solution = solve(problem);
    EXPECT_FALSE(solution.solved());
    EXPECT_NE(solution.reason, "");
  };
  FrictionProblem problem = half_space_problem(4, 0.3);
  problem.q[7] = not_a_number;
  expect_unsolved(problem);
  problem = half_space_problem(4, 0.3);
  problem.w(20, 18) = problem.w(18, 20) = not_a_number;
  expect_unsolved(problem);
  // Indefinite, without a solution.
  problem = FrictionProblem({1, 1}, 0.0);
  problem.w << 1.0, -2.0, -2.0, 1.0;
  problem.q << -1.0, -1.0;
  expect_unsolved(problem);
  // A point that penetrates and that no reaction moves.
  problem = FrictionProblem({2}, 0.3);
  problem.w.setZero();
  problem.q << -1.0, 0.5;
  expect_unsolved(problem);
  problem.w << -1.0, 0.0, 0.0, 1.0;
  expect_unsolved(problem);
}

TEST(FrictionFailure, DoesNotSpoilTheNextProblem) {
  FrictionProblem problem = half_space_problem(4, 0.3);
  const double kept = problem.q[7];
  ContactRun solver;
  ContactSolution solution;
  problem.q[7] = std::numeric_limits<double>::infinity();
  solution = solver.solve(problem);
  EXPECT_FALSE(solution.solved());
  problem.q[7] = kept;
  solution = solver.solve(problem);
  expect_law(problem, solution);
}

/// Nodes in corners of three planes, whose gaps have the error `rounding` and whose slips are much more accurate: if a
/// node sticks to one plane, the slip there is the gap to another one, and the two disagree by that rounding.
FrictionProblem corners(Index nodes, double friction, double rounding, double digits, unsigned seed) {
  std::mt19937 random(seed);
  const Matrix w = random_operator(3 * nodes, digits, random);
  const Vector q = uniform(3 * nodes, random);
  FrictionProblem problem(std::vector<Index>(std::size_t(3 * nodes), 3), friction);
  Matrix rows = Matrix::Zero(9 * nodes, 3 * nodes);
  Vector gaps = Vector::Zero(rows.rows());
  problem.rounding = Vector::Constant(rows.rows(), 1e-15);
  for (Index plane = 0; plane < 3 * nodes; ++plane) {
    const Index row = 3 * plane, node = plane / 3;
    for (Index k = 0; k < 3; ++k) rows(row + k, 3 * node + (plane + k) % 3) = 1.0;
    gaps[row] = rounding * uniform(random);
    problem.rounding[row] = rounding;
  }
  problem.w = rows * w * rows.transpose();
  problem.q = rows * q + gaps;
  return problem;
}

TEST(FrictionInCorners, IsSolvedUpToTheRoundingOfGaps) {
  for (const double rounding : {1e-9, 1e-11}) {
    for (const double digits : {1.0, 4.0}) {
      for (const double friction : {0.3, 0.6}) {
        for (unsigned seed = 0; seed < seeds(20); ++seed) {
          SCOPED_TRACE(testing::Message() << rounding << ", " << digits << " digits, F " << friction << ", " << seed);
          const FrictionProblem problem = corners(8, friction, rounding, digits, seed);
          const ContactSolution solution = solve(problem);
          EXPECT_TRUE(solution.solved()) << solution.reason << ", residual " << solution.residual;
          const Judgement judgement = judge(problem.contact(), solution.reaction);
          EXPECT_LE(judgement.residual, 1e-12 + solution.rounding_floor);
          EXPECT_LE(solution.rounding_floor, 100.0 * rounding);
          EXPECT_LE(judgement.outside_cone, 1e-15);
        }
      }
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
