
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "support/contact_problems.hpp"

namespace ricochet::test_support {
namespace {

TEST(Friction, SolvesRandomProblemsOfManySizes) {
  for (const Index dimension : {2, 3}) {
    for (const Index points : {1, 2, 3, 5, 10, 30, 80, 200}) {
      for (const double friction : {0.0, 0.1, 0.3, 1.0, 3.0}) {
        if (is_sanitized && points > 50) continue;
        for (unsigned seed = 0; seed < seeds(points < 50 ? 20 : 2); ++seed) {
          SCOPED_TRACE(testing::Message()
                       << dimension << "D, " << points << " points, F = " << friction << ", " << seed);
          const FrictionProblem problem = random_problem(points, dimension, friction, seed);
          expect_law(problem, solve(problem));
          if (HasFailure()) return;
        }
      }
    }
  }
}

/// Beyond uniqueness; these are all seeds that were tried.
TEST(Friction, SolvesProblemsWithStrongFriction) {
  for (const Index dimension : {2, 3}) {
    for (const double friction : {2.0, 5.0}) {
      for (unsigned seed = 0; seed < 40; ++seed) {
        SCOPED_TRACE(testing::Message() << dimension << "D, F = " << friction << ", " << seed);
        const FrictionProblem problem = random_problem(12, dimension, friction, seed);
        expect_law(problem, solve(problem));
      }
    }
  }
}

TEST(Friction, SolvesNearlyAllProblemsWithExtremeFrictionAndSaysWhichItDoesNot) {
  int unsolved = 0;
  for (const Index dimension : {2, 3}) {
    for (unsigned seed = 0; seed < 100; ++seed) {
      SCOPED_TRACE(testing::Message() << dimension << "D, " << seed);
      const FrictionProblem problem = random_problem(12, dimension, 100.0, seed);
      const ContactSolution solution = solve(problem);
      if (solution.solved()) {
        expect_law(problem, solution);
      } else {
        ++unsolved;
        EXPECT_GT(solution.residual, 1e-12);
        EXPECT_NE(solution.reason, "");
      }
    }
  }
  EXPECT_LE(unsolved, 4);
}

/// All solutions of a problem in two dimensions, by trying open, stick and slip to either side at every point.
std::vector<Vector> enumerate(const FrictionProblem& problem) {
  std::vector<Vector> solutions;
  const Index points = problem.points();
  const Index rows = problem.q.size();
  for (int code = 0; code < 1 << (2 * points); ++code) {
    Matrix system = Matrix::Zero(rows, rows);
    Vector right = Vector::Zero(rows);
    const auto state = [&](Index i) { return code >> (2 * i) & 3; };
    const auto row_of = [&](Index i) { return problem.row_offset[std::size_t(i)]; };
    const auto has_tangent = [&](Index i) { return row_of(i + 1) - row_of(i) > 1; };
    bool possible = true;
    for (Index i = 0; i < points; ++i) {
      const Index n = row_of(i);
      if (!has_tangent(i) && state(i) > 1) possible = false;
      for (Index row = n; row < row_of(i + 1); ++row) {
        if (state(i) == 0) {
          system(row, row) = 1.0;
        } else if (row == n || state(i) == 1) {
          system.row(row) = problem.w.row(row);
          right[row] = -problem.q[row];
        } else {
          system(row, row) = 1.0;
          system(row, n) = (state(i) == 2 ? -1.0 : 1.0) * problem.coefficient[i];
        }
      }
    }
    if (!possible) continue;
    const Vector rho = system.fullPivLu().solve(right);
    const Vector u = problem.q + problem.w * rho;
    constexpr double small = 1e-11;
    for (Index i = 0; i < points && possible; ++i) {
      const Index n = row_of(i);
      possible = state(i) == 0 ? u[n] >= -small : rho[n] >= -small;
      if (!has_tangent(i) || state(i) == 0) continue;
      if (state(i) == 1) possible = possible && std::abs(rho[n + 1]) <= problem.coefficient[i] * rho[n] + small;
      if (state(i) > 1) possible = possible && (state(i) == 2 ? u[n + 1] <= small : u[n + 1] >= -small);
    }
    if (possible) solutions.push_back(rho);
  }
  return solutions;
}

TEST(Friction, AgreesWithTheEnumerationOfAllStates) {
  for (Index points = 1; points <= 5; ++points) {
    for (const double friction : {0.0, 0.2, 1.0, 3.0}) {
      for (unsigned seed = 0; seed < 6; ++seed) {
        SCOPED_TRACE(testing::Message() << points << " points, F = " << friction << ", " << seed);
        const FrictionProblem problem = random_problem(points, 2, friction, 50 + seed);
        const ContactSolution solution = solve(problem);
        expect_law(problem, solution);
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vector& candidate : enumerate(problem))
          nearest = std::min(nearest, (candidate - solution.reaction).lpNorm<Eigen::Infinity>());
        EXPECT_LE(nearest, 1e-11 * (1.0 + solution.reaction.lpNorm<Eigen::Infinity>()));
      }
    }
  }
}

TEST(Friction, AgreesWithTheActiveSetWithoutFriction) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    FrictionProblem problem = random_problem(40, seed % 2 == 0 ? 2 : 3, 0.0, seed);
    const ContactSolution solution = solve(problem);
    FrictionProblem normals(std::vector<Index>(std::size_t(problem.points()), 1), 0.0);
    const std::vector<Index> rows(problem.row_offset.begin(), problem.row_offset.end() - 1);
    normals.w = problem.w(rows, rows);
    normals.q = problem.q(rows);
    const ContactSolution expected = solve(normals, {}, "active-set");
    EXPECT_LE((solution.reaction(rows) - expected.reaction).lpNorm<Eigen::Infinity>(),
              1e-13 * expected.reaction.lpNorm<Eigen::Infinity>());
    EXPECT_EQ(solution.status, expected.status);
  }
}

TEST(Friction, GivesTheSameBitsInUnitsThatArePowersOfTwoApart) {
  FrictionProblem problem = random_problem(60, 3, 0.7, 3);
  problem.bound.tail(10).setConstant(0.25);
  // Rows of very different size, as from points with different areas.
  for (Index i = 0; i < 30; ++i) {
    const double factor = std::pow(3.0, 0.2 * double(i));
    for (Index row = problem.row_offset[std::size_t(i)]; row < problem.row_offset[std::size_t(i + 1)]; ++row) {
      problem.w.row(row) *= factor;
      problem.w.col(row) *= factor;
      problem.q[row] *= factor;
    }
  }
  const ContactSolution solution = solve(problem);
  ASSERT_TRUE(solution.solved());
  for (const int operator_power : {1, -7, 30}) {
    for (const int offset_power : {0, 3, -40}) {
      FrictionProblem other = problem;
      other.w *= std::ldexp(1.0, operator_power);
      other.q *= std::ldexp(1.0, offset_power);
      other.bound *= std::ldexp(1.0, offset_power - operator_power);
      const ContactSolution scaled = solve(other);
      EXPECT_EQ(scaled.reaction * std::ldexp(1.0, operator_power - offset_power), solution.reaction);
      EXPECT_EQ(scaled.status, solution.status);
      EXPECT_EQ(scaled.iterations, solution.iterations);
      EXPECT_EQ(scaled.residual, solution.residual);
    }
  }
}

TEST(Friction, TurnsWithTheTangentsFrames) {
  for (const FrictionProblem& problem : {random_problem(40, 3, 0.5, 8), half_space_problem(10, 0.3)}) {
    Matrix turn = Matrix::Identity(problem.q.size(), problem.q.size());
    for (std::size_t i = 0; i + 1 < problem.row_offset.size(); ++i) {
      if (problem.row_offset[i + 1] - problem.row_offset[i] < 3) continue;
      const double angle = 0.7 + 1.3 * double(i);
      turn.block<2, 2>(problem.row_offset[i] + 1, problem.row_offset[i] + 1) << std::cos(angle), -std::sin(angle),
          std::sin(angle), std::cos(angle);
    }
    FrictionProblem turned = problem;
    turned.w = turn * problem.w * turn.transpose();
    turned.q = turn * problem.q;
    const ContactSolution solution = solve(problem);
    const ContactSolution other = solve(turned);
    ASSERT_TRUE(solution.solved() && other.solved());
    EXPECT_EQ(other.status, solution.status);
    EXPECT_LE((other.reaction - turn * solution.reaction).lpNorm<Eigen::Infinity>(),
              1e-10 * solution.reaction.lpNorm<Eigen::Infinity>());
  }
}

TEST(Friction, LeavesIneligiblePointsAlone) {
  FrictionProblem problem = random_problem(50, 3, 0.4, 21);
  for (std::size_t i = 0; i < problem.eligible.size(); i += 3) problem.eligible[i] = 0;
  expect_law(problem, solve(problem));
  // Data of ineligible points may be anything.
  problem.q[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(solve(problem).solved());
}

TEST(Friction, IsOpenWhereNothingPresses) {
  FrictionProblem problem = half_space_problem(5, 0.3);
  for (Index i = 0; i < problem.points(); ++i) problem.q[3 * i] = i == 7 ? -1e-14 : 0.25;
  problem.rounding.setConstant(2e-14);
  const ContactSolution solution = solve(problem);
  EXPECT_TRUE(solution.solved());
  EXPECT_EQ(solution.iterations, 0);
  EXPECT_EQ(solution.reaction, Vector::Zero(75));
  problem.rounding.setConstant(0.0);
  EXPECT_GT(solve(problem).reaction[21], 0.0);
}

TEST(Friction, SolvesGrazingPoints) {
  FrictionProblem problem({3, 3, 3}, 0.5);
  problem.q << 0.0, 1.0, 2.0, -1.0, 3.0, 4.0, 0.0, 0.0, 0.0;
  const ContactSolution solution = solve(problem);
  expect_law(problem, solution);
  Vector expected(9);
  expected << 0.0, 0.0, 0.0, 1.0, -0.3, -0.4, 0.0, 0.0, 0.0;
  EXPECT_LE((solution.reaction - expected).norm(), 1e-15);
}

TEST(Friction, SolvesCoulombsLawWithALimit) {
  long limited = 0;
  for (const Index dimension : {2, 3}) {
    for (const double friction : {0.3, 3.0}) {
      for (unsigned seed = 0; seed < 40; ++seed) {
        SCOPED_TRACE(testing::Message() << dimension << "D, F = " << friction << ", " << seed);
        FrictionProblem problem = random_problem(20, dimension, friction, seed);
        problem.bound.setConstant(0.02 * double(1 + seed));
        const ContactSolution solution = solve(problem);
        expect_law(problem, solution);
        for (Index i = 0; i < problem.points(); ++i) {
          const double normal = solution.reaction[problem.row_offset[std::size_t(i)]];
          limited += friction * normal > problem.bound[i] ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(limited, 100);
}

/// The bound jumps where a point opens, and some problems have solutions only on the jump.
TEST(Friction, SolvesTrescasLawAndSaysWhereItDoesNot) {
  int unsolved = 0;
  for (const Index dimension : {2, 3}) {
    for (unsigned seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE(testing::Message() << dimension << "D, " << seed);
      FrictionProblem problem = random_problem(20, dimension, 0.0, seed);
      problem.bound.setConstant(0.02 * double(1 + seed));
      const ContactSolution solution = solve(problem);
      if (solution.solved()) {
        expect_law(problem, solution);
      } else {
        ++unsolved;
        EXPECT_NE(solution.reason, "");
      }
    }
  }
  EXPECT_LE(unsolved, 1);
}

/// Away from the jump Tresca's law has one solution, that of a convex problem.
TEST(Friction, SolvesTrescasLawWherePointsStayPressed) {
  for (const double bound : {1e-3, 0.03, 0.3, 3.0}) {
    FrictionProblem problem = half_space_problem(8, 0.0);
    problem.bound.setConstant(bound);
    for (Index i = 0; i < problem.points(); ++i) problem.q[3 * i] = -3.0;
    for (Index i = 0; i < problem.points(); ++i) problem.q[3 * i + 1] *= 10.0;
    const ContactSolution solution = solve(problem);
    expect_law(problem, solution);
    EXPECT_LE(solution.newton_steps, 10);
  }
}

}  // namespace
}  // namespace ricochet::test_support
