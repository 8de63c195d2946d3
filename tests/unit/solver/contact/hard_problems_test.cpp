#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ricochet/fclib/fclib_file.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "support/hard_contact_problems.hpp"
#include "support/paths.hpp"

/// @file The default solver on hard problems: redundant points, wedges, twelve orders of magnitude, no points and
/// thousands. Solutions reported as solved are judged in long double; unsolved problems must be reported as such.
namespace ricochet::test_support {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

ContactSolution solve(const ContactProblem& problem, double tolerance) {
  const auto solver = make_contact_solver();
  ContactSolution solution;
  solver->analyse(problem);
  solver->solve(problem, {.tolerance = tolerance}, solution);
  return solution;
}

/// Expects that the reported result and residual are true, solved or not. Half of the rounding floor is for the
/// rounding of u in the solver, which is in its residual and not in the judge's. `problem` has the entries of W.
Judgement expect_truth(const ContactProblem& problem, const ContactSolution& solution, double tolerance) {
  EXPECT_TRUE(solution.reaction.allFinite());
  const Judgement judgement = judge(problem, solution.reaction);
  EXPECT_NEAR(solution.residual, judgement.residual, 1e-6 * judgement.residual + solution.rounding_floor);
  EXPECT_LE(judgement.outside_cone, 8.0 * machine_epsilon);
  EXPECT_EQ(solution.solved(), solution.reason.empty());
  if (solution.solved()) {
    EXPECT_LE(judgement.beyond_rounding, tolerance + 0.5 * solution.rounding_floor);
    EXPECT_LE(judgement.residual, tolerance + 1e-6) << "whatever the rounding floor";
  } else {
    EXPECT_GT(judgement.residual, tolerance);
  }
  return judgement;
}

ContactSolution expect_solved(const FrictionProblem& problem, double tolerance) {
  const ContactProblem contact = problem.contact();
  ContactSolution solution = solve(contact, tolerance);
  EXPECT_EQ(solution.outcome, ContactOutcome::solved) << solution.reason << ", residual " << solution.residual;
  expect_truth(contact, solution, tolerance);
  return solution;
}

double largest(const Vector& vector) { return vector.lpNorm<Eigen::Infinity>(); }

// Redundant points.

TEST(HardContact, RigidBodiesOnManyPoints) {
  for (const Index dimension : {2, 3}) {
    for (const Index points : {4, 9, 25, 100}) {
      for (const double friction : {0.0, 0.3, 1.0}) {
        for (unsigned seed = 0; seed < seeds(6); ++seed) {
          SCOPED_TRACE(testing::Message() << dimension << "D, " << points << " points, F " << friction << ", " << seed);
          const FrictionProblem problem = rigid_box(points, dimension, friction, seed);
          expect_solved(problem, 1e-8);
          expect_law(problem, expect_solved(problem, 0.0), 1e-11);
          const FrictionProblem copies = twice(problem);
          expect_law(copies, expect_solved(copies, 0.0), 1e-11);
        }
      }
    }
  }
}

/// Without friction the motion is the projection of the free motion on the admissible ones in the norm of M; the
/// reactions that cause it need not be unique.
TEST(HardContact, TheFrictionlessMotionOfARigidBodyIsUnique) {
  for (const Index dimension : {2, 3}) {
    for (unsigned seed = 0; seed < seeds(20); ++seed) {
      SCOPED_TRACE(testing::Message() << dimension << "D, " << seed);
      const FrictionProblem problem = rigid_box(36, dimension, 0.0, seed);
      const Vector motion = expect_solved(problem, 1e-13).motion;
      const Index rows = motion.size();
      EXPECT_LE(largest(expect_solved(twice(problem), 1e-13).motion - motion.replicate(2, 1)), 1e-10);
      // The points in reverse order.
      std::vector<Index> order;
      for (Index i = problem.points(); i-- > 0;) {
        for (Index k = 0; k < dimension; ++k) order.push_back(dimension * i + k);
      }
      FrictionProblem reversed = problem;
      reversed.w = problem.w(order, order);
      reversed.q = problem.q(order);
      EXPECT_LE(largest(expect_solved(reversed, 1e-13).motion - motion(order)), 1e-10);
      // A different initial guess may lead to different reactions.
      ContactRun run;
      run.set_warm_start(10.0 * Vector::Random(rows).cwiseAbs());
      const ContactSolution& other = run.solve(problem, {.tolerance = 1e-13});
      ASSERT_TRUE(other.solved()) << other.reason;
      EXPECT_LE(largest(other.motion - motion), 1e-10);
    }
  }
}

TEST(HardContact, SymmetricElasticContactWithEveryPointTwice) {
  for (const double friction : {0.0, 0.3, 1.0}) {
    for (const Index side : {3, 5, 8}) {
      SCOPED_TRACE(testing::Message() << side << ", F " << friction);
      FrictionProblem problem = half_space_problem(side, friction);
      // Pressed without twist: the problem is symmetric.
      for (Index i = 0; i < problem.points(); ++i) problem.q.segment(3 * i + 1, 2) << 0.05, 0.0;
      const ContactSolution single = expect_solved(problem, 1e-13);
      const ContactSolution copies = expect_solved(twice(problem), 1e-13);
      EXPECT_LE(largest(copies.motion - single.motion.replicate(2, 1)), 1e-10);
      const Index rows = single.reaction.size();
      const Vector total = copies.reaction.head(rows) + copies.reaction.tail(rows);
      EXPECT_LE(largest(total - single.reaction), 1e-8 * largest(single.reaction));
      for (Index i = 0; i < problem.points(); ++i) {
        const Index mirrored = i % side + side * (side - 1 - i / side);
        EXPECT_NEAR(total[3 * i], total[3 * mirrored], 1e-8 * largest(total));
        EXPECT_NEAR(total[3 * i + 2], -total[3 * mirrored + 2], 1e-8 * largest(total));
      }
    }
  }
}

// Wedges.

struct Count {
  int all = 0, unsolved = 0, locked = 0;
  std::string which;  ///< seeds of unsolved problems
};

/// Counts solved and unsolved wedges of all angles, with F from 0.5 to 3, few points and many.
Count count_wedges(double push, double softness, double preload) {
  Count count;
  unsigned seed = 0;
  for (const Index dimension : {2, 3}) {
    for (const Index points : {3, 4, 8, 30}) {
      for (const double angle : {10.0, 20.0, 30.0, 45.0, 60.0, 70.0, 80.0}) {
        for (const double friction : {0.5, 1.0, 2.0, 3.0}) {
          if (++seed % (is_sanitized ? 17 : 1) != 0) continue;
          SCOPED_TRACE(testing::Message() << dimension << "D, " << points << " points, " << angle << " degrees, F "
                                          << friction << ", softness " << softness << ", " << seed);
          const ContactProblem problem =
              wedged_body(points, dimension, friction, angle * degree, push, softness, preload, seed).contact();
          const ContactSolution solution = solve(problem, 1e-8);
          expect_truth(problem, solution, 1e-8);
          ++count.all;
          if (!solution.solved()) {
            ++count.unsolved;
            count.which += testing::PrintToString(dimension) + "D " + std::to_string(seed) + ", ";
          }
          if (friction > std::tan(angle * degree) && solution.reaction.maxCoeff() > 0.0) ++count.locked;
        }
      }
    }
  }
  return count;
}

TEST(HardContact, WedgedBodies) {
  // A rigid body that is pushed in, and slightly compliant bodies: their problems have solutions.
  for (const double softness : {0.0, 1e-1, 1e-3, 1e-6}) {
    const Count in = count_wedges(1.0, softness, 0.0);
    EXPECT_GT(in.locked, in.all / 3);
    EXPECT_EQ(in.unsolved, 0) << "softness " << softness << ": " << in.which;
    if (softness == 0.0) continue;
    const Count out = count_wedges(-1.0, softness, 1.0);
    EXPECT_GT(out.locked, out.all / 3);
    EXPECT_EQ(out.unsolved, 0) << "softness " << softness << ": " << out.which;
    const Count receding = count_wedges(1.0, softness, -0.3);
    EXPECT_EQ(receding.unsolved, 0) << "softness " << softness << ": " << receding.which;
  }
}

/// Converging walls with a rigid body between them.
TEST(HardContact, WhatHasNoSolutionIsNotSolved) {
  for (const Index dimension : {2, 3}) {
    for (const double friction : {0.0, 0.5, 3.0}) {
      for (const int pairs : {1, 2, 5}) {
        if (is_sanitized && (friction != 0.5 || pairs != 1)) continue;
        std::vector<RigidPoint> places;
        for (int k = 0; k < pairs; ++k) {
          for (const double side : {-1.0, 1.0}) places.push_back({{side, 0.0, 0.2 * k}, {-side, 0.0, 0.0}});
        }
        FrictionProblem problem = rigid_problem(places, {2.0, 1.0, 1.0}, Vector::Constant(6, 0.1), dimension, friction);
        for (Index i = 0; i < problem.points(); ++i) problem.q[dimension * i] -= 1.0;
        const ContactSolution solution = solve(problem.contact(), 1e-8);
        EXPECT_EQ(solution.outcome, ContactOutcome::not_converged);
        expect_truth(problem.contact(), solution, 1e-8);
        EXPECT_GT(solution.residual, 1e-3);
      }
    }
  }
}

/// A rigid rod on a rough plane (P. Painlevé, C. R. Acad. Sci. 121 (1895) 112): u_T − a u_N = q_T − a q_N = s for every
/// r; with s > 0 the rod must slip, r_T = −F r_N, and u_N = q_N + (1 − a F) r_N < 0 for a F > 1. A rod of any small
/// compliance sticks instead; as the compliance vanishes, its reaction grows until the motion is lost in rounding.
TEST(HardContact, PainlevesRod) {
  for (const Index dimension : {2, 3}) {
    for (const double slope : {0.5, 2.0}) {
      for (const double softness : {0.0, 1e-14, 1e-6, 1e-2}) {
        if (is_sanitized && softness == 1e-14) continue;
        SCOPED_TRACE(testing::Message() << dimension << "D, slope " << slope << ", softness " << softness);
        FrictionProblem problem(std::vector<Index>{dimension}, 1.0);
        Vector column = Vector::Zero(dimension);
        column[0] = 1.0;
        column[1] = slope;
        problem.w = column * column.transpose();
        problem.w.diagonal().array() += softness;
        problem.q = -column;
        problem.q[1] += 0.25;
        const ContactProblem contact = problem.contact();
        const ContactSolution solution = solve(contact, 1e-8);
        expect_truth(contact, solution, 1e-8);
        EXPECT_EQ(solution.solved(), softness > 1e-14 || slope < 1.0) << solution.reason << ' ' << solution.residual;
      }
    }
  }
}

// Twelve orders of magnitude.

TEST(HardContact, TwelveOrdersOfMassesAndStiffnesses) {
  int unsolved = 0;
  std::string which;
  for (const Index dimension : {2, 3}) {
    for (const double friction : {0.0, 0.3, 1.0, 3.0}) {
      for (unsigned seed = 0; seed < seeds(10); ++seed) {
        for (const double power : {1.0, 0.0, 2.0}) {
          SCOPED_TRACE(testing::Message() << dimension << "D, F " << friction << ", power " << power << ", " << seed);
          const FrictionProblem problem = unequal_bodies(40, dimension, friction, 12.0, power, seed);
          ASSERT_LE(problem.w.diagonal().minCoeff(), 1e-11 * problem.w.diagonal().maxCoeff());
          const ContactProblem contact = problem.contact();
          const ContactSolution solution = solve(contact, 1e-8);
          const Judgement judgement = expect_truth(contact, solution, 1e-8);
          // Every point has about the same weight in the residual: none is neglected.
          if (power == 1.0 && solution.solved()) {
            EXPECT_LE(judgement.own_residual, 1e-7);
          }
          // The tolerance 0 requires rounding at each point separately.
          const ContactSolution best = solve(contact, 0.0);
          const Judgement of_best = expect_truth(contact, best, 1e-12);
          if (best.solved()) {
            EXPECT_LE(of_best.own_residual, power == 1.0 ? 1e-12 : 1e-10);
          }
          if (!solution.solved() || !best.solved()) {
            ++unsolved;
            which += testing::PrintToString(dimension) + "D, power " + std::to_string(power) + ", seed " +
                     std::to_string(seed) + "; ";
          }
        }
      }
    }
  }
  EXPECT_EQ(unsolved, 0) << which;
}

/// D W D with any factors from 1e-6 to 1: the same problem, the same solution.
TEST(HardContact, PointsScaledByAnyFactors) {
  for (const Index dimension : {2, 3}) {
    for (unsigned seed = 0; seed < seeds(10); ++seed) {
      SCOPED_TRACE(testing::Message() << dimension << "D, " << seed);
      const FrictionProblem problem = unequal_bodies(30, dimension, 0.3, 0.0, 1.0, seed);
      std::mt19937 random(seed);
      const Vector factors = decades_of(problem.points(), dimension, 6.0, 1, random);
      FrictionProblem scaled = problem;
      scaled.w = factors.asDiagonal() * problem.w * factors.asDiagonal();
      scaled.q = factors.cwiseProduct(problem.q);
      const Vector expected = expect_solved(problem, 0.0).reaction;
      const Vector found = factors.cwiseProduct(expect_solved(scaled, 0.0).reaction);
      EXPECT_LE(largest(found - expected), 1e-11 * largest(expected));
      // The points of a rigid body in different units.
      FrictionProblem rigid = rigid_box(30, dimension, 0.3, seed);
      rigid.w = factors.asDiagonal() * rigid.w * factors.asDiagonal();
      rigid.q = factors.cwiseProduct(rigid.q);
      EXPECT_LE(judge(rigid.contact(), expect_solved(rigid, 1e-8).reaction).own_residual, 1e-7);
    }
  }
}

// No points, and thousands.

TEST(HardContact, NoPoints) {
  const auto nothing = [](const Vector&, Vector& y) { y.resize(0); };
  for (const auto& w : {make_dense_operator(Matrix(0, 0)), make_sparse_operator(SparseMatrix(0, 0)),
                        make_product_operator(0, nothing)}) {
    for (const Index dimension : {1, 2, 3}) {
      const ContactSolution solution = solve(ContactProblem(dimension, w, Vector(0), Vector(0)), 1e-8);
      EXPECT_TRUE(solution.solved()) << solution.reason;
      EXPECT_EQ(solution.reaction.size(), 0);
      EXPECT_EQ(solution.motion.size(), 0);
      EXPECT_EQ(solution.residual, 0.0);
      EXPECT_TRUE(solution.status.empty());
    }
  }
}

TEST(HardContact, OnePoint) {
  const double tiny = 1e-290;
  for (const double unit : {1.0, 1e-12, 1e12, tiny, 1.0 / tiny}) {
    SCOPED_TRACE(unit);
    FrictionProblem problem({3}, 0.5);
    problem.w.diagonal() << 2.0 * unit, 4.0 * unit, 4.0 * unit;
    const auto expect = [&](const Eigen::Vector3d& q, const Eigen::Vector3d& reaction, ContactStatus status) {
      problem.q = q;
      const ContactSolution solution = solve(problem.contact(), 0.0);
      ASSERT_TRUE(solution.solved()) << solution.reason;
      EXPECT_LE(largest(unit * solution.reaction - reaction), 1e-14);
      EXPECT_EQ(solution.status.front(), status);
    };
    expect({1.0, 3.0, 4.0}, {0.0, 0.0, 0.0}, ContactStatus::open);
    expect({-2.0, 0.6, 0.8}, {1.0, -0.15, -0.2}, ContactStatus::stick);
    expect({-2.0, 3.0, 4.0}, {1.0, -0.3, -0.4}, ContactStatus::slip);
  }
}

/// 5041 points, 15123 rows in three dimensions (under the sanitizers a tenth).
TEST(HardContact, FiveThousandPoints) {
  for (const Index dimension : {1, 2, 3}) {
    for (const double coupling : {1.0, -1.0}) {
      for (const double friction : {0.5, 3.0}) {
        SCOPED_TRACE(testing::Message() << dimension << "D, coupling " << coupling << ", F " << friction);
        const ContactProblem problem = lattice_problem(is_sanitized ? 23 : 71, dimension, friction, coupling, 0.5, 1);
        const ContactSolution solution = solve(problem, 1e-8);
        EXPECT_TRUE(solution.solved()) << solution.reason;
        expect_truth(problem, solution, 1e-8);
      }
    }
  }
}

/// A finite element problem on which the Newton iteration of the default solver cycles: another Newton method takes
/// over, instead of thousands of sweeps.
TEST(HardContact, NewtonThatCycles) {
  const ContactProblem problem = reduce(read_fclib(data_path("contact/newton-cycles.hdf5"))).problem;
  for (const double tolerance : {0.0, 1e-10}) {
    const ContactSolution solution = solve(problem, tolerance);
    EXPECT_TRUE(solution.solved()) << solution.reason;
    EXPECT_LT(solution.iterations, 200);
    expect_truth(problem, solution, std::max(tolerance, 1e-12));
  }
}

/// W given by products, with too many rows to assemble its entries: the rounding floor is no excuse.
TEST(HardContact, ThousandsOfPointsByProducts) {
  struct Size {
    Index side, dimension;
  };
  for (const auto [side, dimension] : {Size{71, 1}, Size{32, 3}}) {
    for (const double coupling : {1.0, -1.0}) {
      if (is_sanitized && (dimension != 3 || coupling < 0.0)) continue;
      constexpr double tolerance = 1e-12;
      SCOPED_TRACE(testing::Message() << dimension << "D, coupling " << coupling);
      const ContactProblem problem = lattice_problem(side, dimension, 0.5, coupling, 0.5, 1);
      ContactProblem by_products = problem;
      by_products.contact_operator = make_product_operator(
          problem.rows(), [&](const Vector& x, Vector& y) { problem.contact_operator->multiply(x, y); });
      const ContactSolution solution = solve(by_products, tolerance);
      EXPECT_TRUE(solution.solved()) << solution.reason;
      expect_truth(problem, solution, tolerance);
      EXPECT_LE(solution.rounding_floor, 1e-11);
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
