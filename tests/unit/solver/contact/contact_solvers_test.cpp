#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/contact_solver_test.hpp"

/// @file Solutions of every solver of the library, judged by an independent residual.
namespace ricochet::test_support {
namespace {

using Long = long double;
using LongVector = Eigen::Matrix<Long, Eigen::Dynamic, 1>;

/// Projection on |r_T| ≤ F r_N.
LongVector project(Long friction, const LongVector& r) {
  const Index tangents = r.size() - 1;
  const Long length = r.tail(tangents).norm();
  if (friction * length <= -r[0]) return LongVector::Zero(r.size());
  if (length <= friction * r[0]) return r;
  LongVector result = r;
  result[0] = (r[0] + friction * length) / (1 + friction * friction);
  if (length > 0) result.tail(tangents) *= friction * result[0] / length;
  return result;
}

/// Residual as defined in the headers: the largest |r − P_K(r − û/w)| √w over the eligible points.
Long measure(const FrictionProblem& problem, const LongVector& reaction) {
  const LongVector u = problem.q.cast<Long>() + problem.w.cast<Long>() * reaction;
  Long largest = 0;
  for (Index i = 0; i < problem.points(); ++i) {
    const auto at = std::size_t(i);
    if (problem.eligible[at] == 0) continue;
    const Index row = problem.row_offset[at];
    const bool friction = problem.row_offset[at + 1] - row > 1 && problem.coefficient[i] > 0.0;
    const Index size = friction ? problem.row_offset[at + 1] - row : 1;
    const Long w = problem.w.diagonal().segment(row, size).cast<Long>().mean();
    const LongVector r = reaction.segment(row, size);
    LongVector step = u.segment(row, size);
    step[0] += Long(problem.coefficient[i]) * step.tail(size - 1).norm();
    const LongVector arrived = r - step / w;
    const LongVector projected = project(friction ? Long(problem.coefficient[i]) : Long(0), arrived);
    largest = std::max(largest, (r - projected).norm() * std::sqrt(w));
  }
  return largest;
}

/// The residual relative to the data.
double true_residual(const FrictionProblem& problem, const Vector& reaction) {
  const LongVector none = LongVector::Zero(reaction.size());
  return double(measure(problem, reaction.cast<Long>()) / measure(problem, none));
}

/// Expects a solution to the tolerance, reported as solved.
void expect_solved(const FrictionProblem& problem, const ContactSolution& solution, double tolerance) {
  ASSERT_EQ(solution.outcome, ContactOutcome::solved) << solution.reason << ", residual " << solution.residual;
  EXPECT_EQ(solution.reason, "");
  const double residual = true_residual(problem, solution.reaction);
  EXPECT_LE(residual, tolerance + solution.rounding_floor);
  EXPECT_NEAR(residual, solution.residual, 1e-6 * residual + solution.rounding_floor);
  EXPECT_LE(solution.rounding_floor, 1e-9);
}

/// The problem with D W D, D q and the same coefficients: r becomes D⁻¹ r.
FrictionProblem scaled(const FrictionProblem& problem, const Vector& scales) {
  FrictionProblem result = problem;
  result.w = scales.asDiagonal() * problem.w * scales.asDiagonal();
  result.q = scales.asDiagonal() * problem.q;
  return result;
}

/// Scales with one factor for all rows of a point.
Vector point_scales(const FrictionProblem& problem, const std::function<double(Index)>& scale) {
  Vector result(problem.q.size());
  for (Index i = 0; i < problem.points(); ++i) {
    const auto at = std::size_t(i);
    result.segment(problem.row_offset[at], problem.row_offset[at + 1] - problem.row_offset[at]).setConstant(scale(i));
  }
  return result;
}

class ContactSolvers : public ContactSolverTest {};

TEST_P(ContactSolvers, MeetTheLawAtEveryPoint) {
  for (Index size = 1; size <= dimension(); ++size) {
    for (const double friction : {0.0, 0.1, 0.3, 1.0}) {
      for (unsigned seed = 0; seed < 4; ++seed) {
        SCOPED_TRACE(testing::Message() << size << "D, F = " << friction << ", " << seed);
        FrictionProblem problem = random_problem(30, size, friction, seed);
        for (std::size_t i = seed; i < problem.eligible.size(); i += 5) problem.eligible[i] = 0;
        const ContactSolution solution = solve(problem, {.tolerance = 1e-12});
        expect_solved(problem, solution, 1e-12);
        expect_law(problem, solution, 1e-10);
      }
    }
  }
}

TEST_P(ContactSolvers, RespectTheTolerance) {
  for (const double tolerance : {1e-4, 1e-8}) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE(testing::Message() << tolerance << ", " << seed);
      const FrictionProblem problem = random_problem(40, dimension(), 0.5, seed, 3.0);
      expect_solved(problem, solve(problem, {.tolerance = tolerance}), tolerance);
    }
    if (dimension() == 3) {
      const FrictionProblem problem = half_space_problem(6, 0.3);
      expect_solved(problem, solve(problem, {.tolerance = tolerance}), tolerance);
    }
  }
}

/// The solution is unique where W is well conditioned and friction small.
TEST_P(ContactSolvers, AgreeWithGaussSeidel) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const FrictionProblem problem = random_problem(30, dimension(), 0.2, seed);
    const ContactSolution reference = test_support::solve(problem, {.tolerance = 1e-13}, "gauss-seidel");
    const ContactSolution solution = solve(problem, {.tolerance = 1e-12});
    ASSERT_TRUE(solution.solved()) << solution.reason;
    EXPECT_LE((solution.reaction - reference.reaction).lpNorm<Eigen::Infinity>(),
              1e-10 * reference.reaction.lpNorm<Eigen::Infinity>());
    EXPECT_EQ(solution.status, reference.status);
  }
}

TEST_P(ContactSolvers, StartFromTheLastSolution) {
  FrictionProblem problem = random_problem(40, dimension(), 0.3, 7, 2.0);
  ContactRun run(GetParam());
  const int cold = run.solve(problem, {.tolerance = 1e-6}).iterations;
  EXPECT_GT(cold, 0);
  const ContactSolution first = run.solve(problem, {.tolerance = 1e-6});
  EXPECT_TRUE(first.solved());
  EXPECT_EQ(first.newton_steps, 0) << "an already solved problem takes no step";
  problem.q *= 1.0 + 1e-7;
  const ContactSolution next = run.solve(problem, {.tolerance = 1e-6});
  expect_solved(problem, next, 1e-6);
  EXPECT_LT(next.iterations, cold);
  // From the same start another solver object finds the same bits.
  problem.q *= 1.01;
  ContactRun resumed(GetParam());
  resumed.start_with(run.saved());
  const ContactSolution expected = run.solve(problem, {.tolerance = 1e-6});
  EXPECT_EQ(resumed.solve(problem, {.tolerance = 1e-6}).reaction, expected.reaction);
}

TEST_P(ContactSolvers, RecordWithoutChangingAnything) {
  for (const double strength : {0.2, 1.0}) {
    const FrictionProblem problem = random_problem(is_sanitized ? 50 : 130, dimension(), 0.4, 5, strength);
    const ContactSolution plain = solve(problem, {.tolerance = 1e-9});
    const ContactSolution recorded = solve(problem, {.tolerance = 1e-9, .record = true});
    EXPECT_EQ(recorded.reaction, plain.reaction);
    EXPECT_EQ(recorded.iterations, plain.iterations);
    EXPECT_EQ(recorded.record.size(), std::size_t(plain.iterations));
  }
}

TEST_P(ContactSolvers, SayWhatTheyDidNotSolve) {
  const FrictionProblem problem = random_problem(60, dimension(), 1.0, 3, 4.0);
  const ContactSolution solution = solve(problem, {.tolerance = 1e-10, .iteration_limit = 1, .record = true});
  const double residual = true_residual(problem, solution.reaction);
  EXPECT_EQ(int(solution.record.size()), solution.iterations);
  if (solution.solved()) {
    EXPECT_EQ(GetParam(), "automatic") << "all others stop at the limit";
    EXPECT_LE(residual, 1e-10 + solution.rounding_floor);
    return;
  }
  EXPECT_EQ(solution.outcome, ContactOutcome::not_converged);
  EXPECT_NE(solution.reason, "");
  EXPECT_GT(solution.residual, 1e-10);
  EXPECT_NEAR(solution.residual, residual, 1e-9 * residual);
}

/// Under strong friction solutions need not exist or be found, but "solved" is true.
TEST_P(ContactSolvers, NeverCallALargeResidualSolved) {
  int solved = 0;
  for (const double friction : {3.0, 10.0, 100.0}) {
    for (unsigned seed = 0; seed < seeds(5); ++seed) {
      const FrictionProblem problem = random_problem(15, dimension(), friction, seed, 2.0);
      const ContactSolution solution = solve(problem, {.tolerance = 1e-8, .iteration_limit = 2000});
      const double residual = true_residual(problem, solution.reaction);
      if (solution.solved()) {
        ++solved;
        EXPECT_LE(residual, 1e-8 + solution.rounding_floor);
      } else {
        EXPECT_NE(solution.reason, "");
        EXPECT_GT(residual, 1e-8);
      }
      for (const Index row : problem.row_offset) {
        if (row < problem.q.size()) {
          EXPECT_GE(solution.reaction[row], 0.0);
        }
      }
    }
  }
  EXPECT_GE(solved, 1);
}

TEST_P(ContactSolvers, GiveTheSameBitsInUnitsThatDifferByPowersOfTwo) {
  const FrictionProblem problem = random_problem(25, dimension(), 0.4, 5, 2.0);
  const ContactOptions options{.tolerance = 1e-9};
  const ContactSolution solution = solve(problem, options);
  ASSERT_TRUE(solution.solved());
  std::mt19937 random(1);
  const Vector scales = point_scales(problem, [&](Index) { return std::ldexp(1.0, int(random() % 41) - 20); });
  FrictionProblem other = scaled(problem, scales);
  const ContactSolution by_points = solve(other, options);
  EXPECT_EQ(Vector(scales.asDiagonal() * by_points.reaction), solution.reaction);
  EXPECT_EQ(by_points.residual, solution.residual);
  EXPECT_EQ(by_points.iterations, solution.iterations);
  for (const int exponent : {-73, 37, 40}) {
    other = problem;
    other.q *= 0x1p23;
    other.w *= std::ldexp(1.0, exponent);
    const ContactSolution by_units = solve(other, options);
    EXPECT_EQ(Vector(by_units.reaction * std::ldexp(1.0, exponent - 23)), solution.reaction) << exponent;
    EXPECT_EQ(by_units.residual, solution.residual);
  }
}

TEST_P(ContactSolvers, MeasureTheSameInAnyScaling) {
  const FrictionProblem problem = random_problem(25, dimension(), 0.4, 6, 2.0);
  std::mt19937 random(2);
  const Vector scales = point_scales(problem, [&](Index) { return std::pow(10.0, 6.0 * uniform(random)); });
  const FrictionProblem other = scaled(problem, scales);
  const ContactSolution solution = solve(other, {.tolerance = 1e-5});
  expect_solved(other, solution, 1e-5);
  const double residual = true_residual(problem, scales.asDiagonal() * solution.reaction);
  EXPECT_NEAR(solution.residual, residual, 1e-10);
}

/// A problem that couples neighbours only.
FrictionProblem chain(Index points, Index dimension, double friction) {
  FrictionProblem problem(std::vector<Index>(std::size_t(points), dimension), friction);
  std::mt19937 random(3);
  for (Index i = 0; i < points; ++i) {
    const auto own = [&](Index j) { return Eigen::seqN(j * dimension, dimension); };
    problem.w(own(i), own(i)).diagonal().setConstant(2.5);
    if (i == 0) continue;
    Matrix coupling(dimension, dimension);
    for (double& value : coupling.reshaped()) value = 0.3 * uniform(random);
    coupling.diagonal().array() -= 0.5;
    problem.w(own(i), own(i - 1)) = coupling;
    problem.w(own(i - 1), own(i)) = coupling.transpose();
  }
  problem.q = uniform(points * dimension, random);
  for (std::size_t i = 0; i < problem.eligible.size(); i += 7) problem.eligible[i] = 0;
  problem.coefficient[4] = 0.0;
  return problem;
}

TEST_P(ContactSolvers, TakeSparseOperatorsAndProducts) {
  const FrictionProblem problem = chain(40, dimension(), 0.4);
  const ContactOptions options{.tolerance = 1e-12};
  const ContactSolution dense = solve(problem, options);
  ASSERT_TRUE(dense.solved()) << dense.reason;
  const auto same = [&](const ContactSolution& solution) {
    expect_solved(problem, solution, 1e-12);
    EXPECT_LE((solution.reaction - dense.reaction).lpNorm<Eigen::Infinity>(), 1e-10);
    EXPECT_EQ(solution.status, dense.status);
  };
  same(solve(
      problem.contact(make_product_operator(problem.w.rows(), [&](const Vector& x, Vector& y) { y = problem.w * x; })),
      options));
  const ContactSolution sparse =
      solve(problem.contact(make_sparse_operator(SparseMatrix(problem.w.sparseView()))), options);
  if (sparse.outcome == ContactOutcome::not_applicable) {
    EXPECT_EQ(GetParam(), "active-set");
    EXPECT_NE(sparse.reason, "");
  } else {
    same(sparse);
  }
}

/// Too many rows for entries: products alone, or a refusal.
TEST_P(ContactSolvers, TakeLargeProductsOrSayThatTheyDoNot) {
  constexpr Index points = 1600;
  const Index size = dimension();
  const Index rows = points * size;
  const auto multiply = [&](const Vector& x, Vector& y) {
    y = 2.0 * x;
    y.head(rows - size) -= 0.6 * x.tail(rows - size);
    y.tail(rows - size) -= 0.6 * x.head(rows - size);
  };
  std::mt19937 random(9);
  const ContactProblem problem(size, make_product_operator(rows, multiply), uniform(rows, random),
                               Vector::Constant(points, 0.3));
  const ContactSolution solution = solve(problem, {.tolerance = 1e-8});
  const bool by_products =
      GetParam() == "automatic" || GetParam() == "accelerated-gradient" || GetParam() == "extragradient";
  if (!by_products) {
    EXPECT_FALSE(solution.solved());
    EXPECT_NE(solution.reason, "");
    return;
  }
  ASSERT_TRUE(solution.solved()) << solution.reason;
  Vector u;
  multiply(solution.reaction, u);
  u += problem.offset;
  for (Index i = 0; i < points; ++i) {
    const double normal = solution.reaction[size * i];
    EXPECT_GE(u[size * i], -1e-7);
    EXPECT_LE(std::min(normal, u[size * i]), 1e-7);
    EXPECT_LE(solution.reaction.segment(size * i + 1, size - 1).norm(), 0.3 * normal * (1.0 + 1e-15));
  }
}

TEST_P(ContactSolvers, TakeFrictionBoundsOrSayThatTheyDoNot) {
  const std::vector<std::string> of_cones{"newton-fischer-burmeister", "accelerated-gradient", "extragradient", "admm"};
  const bool refuses = std::ranges::find(of_cones, GetParam()) != of_cones.end();
  for (const double friction : {0.0, 0.5}) {
    for (unsigned seed = 0; seed < 5; ++seed) {
      FrictionProblem problem = random_problem(20, dimension(), friction, seed);
      problem.bound.setConstant(0.2);
      const ContactSolution solution = solve(problem, {.tolerance = 1e-12});
      if (refuses) {
        EXPECT_EQ(solution.outcome, ContactOutcome::not_applicable);
        EXPECT_NE(solution.reason, "");
      } else if (friction > 0.0 || solution.solved()) {
        expect_law(problem, solution, 1e-10);
      }
    }
  }
}

/// Every point occurs twice: W has half its rank, u is unchanged.
TEST_P(ContactSolvers, FindTheMotionOfPointsThatAreThereTwice) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const FrictionProblem single = random_problem(15, dimension(), 0.3, seed);
    std::vector<Index> sizes, rows;
    for (std::size_t i = 0; i + 1 < single.row_offset.size(); ++i) {
      for (int copy = 0; copy < 2; ++copy) {
        sizes.push_back(single.row_offset[i + 1] - single.row_offset[i]);
        for (Index row = single.row_offset[i]; row < single.row_offset[i + 1]; ++row) rows.push_back(row);
      }
    }
    FrictionProblem twice(sizes, 0.3);
    twice.w = single.w(rows, rows);
    twice.q = single.q(rows);
    const ContactSolution solution = solve(twice, {.tolerance = 1e-10});
    expect_solved(twice, solution, 1e-10);
    const ContactSolution expected = test_support::solve(single, {.tolerance = 1e-12});
    EXPECT_LE((solution.motion - expected.motion(rows)).lpNorm<Eigen::Infinity>(), 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ContactSolvers, every_contact_solver(), contact_solver_test_name);

}  // namespace
}  // namespace ricochet::test_support
