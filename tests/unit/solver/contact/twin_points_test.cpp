#include <gtest/gtest.h>

#include <random>

#include "ricochet/solver/contact/twin_points.hpp"
#include "support/contact_problems.hpp"
#include "support/hard_contact_problems.hpp"

/// @file Nodes that meet several planes, parallel up to a tiny angle.
namespace ricochet::test_support {
namespace {

/// Each node meets `planes` planes, inclined by multiples of `angle`, at distances that follow from the inclination at
/// its position: gaps differ by the angle times a length.
FrictionProblem inclined_planes(Index nodes, Index dimension, Index planes, double angle, double friction,
                                unsigned seed) {
  std::mt19937 random(seed);
  const Matrix w = random_operator(nodes * dimension, 1.0, random);
  Vector q(nodes * dimension);
  for (Index node = 0; node < nodes; ++node) {
    q.segment(node * dimension, dimension) = uniform(dimension, random);
    q[node * dimension] *= 0.1;
  }
  FrictionProblem problem(std::vector<Index>(std::size_t(nodes * planes), dimension), friction);
  Matrix rows = Matrix::Zero(nodes * planes * dimension, nodes * dimension);
  Vector gaps = Vector::Zero(rows.rows());
  for (Index node = 0; node < nodes; ++node) {
    const double place = uniform(random);
    for (Index plane = 0; plane < planes; ++plane) {
      const Index row = (node * planes + plane) * dimension, column = node * dimension;
      const double tilt = angle * double(plane % 2 == 0 ? plane : -plane);
      rows.block(row, column, dimension, dimension).setIdentity();
      rows(row, column + 1) = tilt;
      rows(row + 1, column) = -tilt;
      gaps[row] = tilt * place;
    }
  }
  problem.w = rows * w * rows.transpose();
  problem.q = rows * q + gaps;
  problem.rounding = Vector::Constant(rows.rows(), 1e-15);
  return problem;
}

TEST(TwinPoints, OneOfNearlyParallelPlanesPresses) {
  int closed = 0;
  for (const Index dimension : {2, 3}) {
    for (const double angle : {1e-7, 1e-9, 1e-11, 1e-12, 1e-13}) {
      for (const double friction : {0.1, 0.3, 0.8}) {
        for (unsigned seed = 0; seed < seeds(8); ++seed) {
          SCOPED_TRACE(testing::Message() << dimension << "D, angle " << angle << ", F " << friction << ", " << seed);
          const FrictionProblem problem = inclined_planes(7, dimension, 3, angle, friction, seed);
          const ContactSolution solution = solve(problem);
          EXPECT_TRUE(solution.solved()) << solution.reason << ", residual " << solution.residual;
          const Judgement judgement = judge(problem.contact(), solution.reaction);
          EXPECT_LE(judgement.residual, 1e-12 + solution.rounding_floor);
          EXPECT_LE(judgement.outside_cone, 1e-15);
          closed += (solution.reaction.array() > 0.0).any() ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(closed, 0);
}

/// If W cannot distinguish points, the free motion decides; other points are left alone.
TEST(TwinPoints, AreFoundByW) {
  TwinPoints twins;
  FrictionProblem apart = random_problem(12, 3, 0.3, 1);
  EXPECT_FALSE(twins.any(*apart.contact().contact_operator, apart.row_offset));
  const FrictionProblem near = inclined_planes(4, 3, 2, 1e-9, 0.3, 1);
  twins.forget();
  const ContactProblem problem = near.contact();
  ASSERT_TRUE(twins.any(*problem.contact_operator, problem.row_offset));
  std::vector<char> wanted(8, 1);
  Vector motion = near.q, reaction = Vector::Ones(24);
  motion[3] = motion[0] - 1.0;
  twins.choose(problem, motion, wanted, reaction);
  EXPECT_EQ(wanted[0], 0);
  EXPECT_EQ(wanted[1], 1);
  EXPECT_EQ(std::ranges::count(wanted, 1), 4);
  EXPECT_EQ(reaction.segment(0, 6), (Vector(6) << 0, 0, 0, 2, 2, 2).finished());
  // The other one is deeper now: it replaces the first and receives its reaction.
  motion[0] = -2.0;
  motion[3] = -1.0;
  EXPECT_TRUE(twins.exchange(problem, motion, wanted, reaction));
  EXPECT_EQ(wanted[0], 1);
  EXPECT_EQ(wanted[1], 0);
  EXPECT_EQ(reaction.segment(0, 6), (Vector(6) << 2, 2, 2, 0, 0, 0).finished());
  EXPECT_FALSE(twins.exchange(problem, motion, wanted, reaction));
  // Parallel, but under another law, hence distinct.
  ContactProblem other = problem;
  other.friction_coefficient[0] = 0.0;
  wanted.assign(8, 1);
  twins.choose(other, motion, wanted, reaction);
  EXPECT_EQ(wanted[0] + wanted[1], 2);
}

}  // namespace
}  // namespace ricochet::test_support
