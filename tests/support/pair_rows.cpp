#include "support/pair_rows.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace ricochet::test_support {

std::string name_of(const PairOfBoxes& of) {
  return fmt::format("shape {}, {}, degree {}", int(of.shape), of.multipliers, of.degree);
}

Vector gaps(const SemidiscreteProblem& problem, const Vector& displacement) {
  Vector result;
  problem.gaps(displacement, 0.0, result);
  return result;
}

void expect_balance(const SemidiscreteProblem& problem, const ContactRows& rows, const Vector& displacement,
                    double tolerance, const std::string& what) {
  const Index d = problem.dimension;
  for (Index point = 0; point < rows.size(); ++point) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    rows.visit_normal(point, [&](Index dof, double value) {
      Eigen::Vector3d place = Eigen::Vector3d::Zero();
      place.head(d) = problem.nodes.col(dof / d) + displacement.segment(dof / d * d, d);
      const Eigen::Vector3d own = value * Eigen::Vector3d::Unit(dof % d);
      force += own;
      moment += place.cross(own);
    });
    EXPECT_LT(force.norm(), tolerance) << what;
    EXPECT_LT(moment.norm(), tolerance) << what;
  }
}

void expect_change_of_gaps(const SemidiscreteProblem& problem, const ContactRows& rows, const Vector& first,
                           const Vector& second, const std::string& what) {
  Vector change;
  rows.normal_motion(second - first, change);
  EXPECT_LT((gaps(problem, second) - gaps(problem, first) - change).lpNorm<Eigen::Infinity>(), 1e-13) << what;
  EXPECT_GT(change.lpNorm<Eigen::Infinity>(), 1e-3);
}

void expect_invariant_gaps(const SemidiscreteProblem& problem, const Vector& displacement, const std::string& what) {
  const Index d = problem.dimension;
  Matrix turn = Matrix::Identity(d, d);
  turn.topLeftCorner(2, 2) << std::cos(2.0), -std::sin(2.0), std::sin(2.0), std::cos(2.0);
  if (d == 3) turn = Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix() * turn;
  Points moved = turn * (problem.nodes + displacement.reshaped(d, problem.nodes.cols()));
  moved.colwise() += Vector::LinSpaced(d, 1.0, 3.0);
  const Vector gap = gaps(problem, displacement);
  EXPECT_LT((gaps(problem, Points(moved - problem.nodes).reshaped()) - gap).lpNorm<Eigen::Infinity>(), 1e-13) << what;
  EXPECT_GT(gap.lpNorm<Eigen::Infinity>(), 1e-3);
}

}  // namespace ricochet::test_support
