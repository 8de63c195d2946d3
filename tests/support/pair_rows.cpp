#include "support/pair_rows.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

namespace ricochet::test_support {

std::string name_of(const PairOfBoxes& of) {
  return fmt::format("shape {}, {}, degree {}", static_cast<int>(of.shape), of.multipliers, of.degree);
}

Vector gaps(const SemidiscreteProblem& problem, const Vector& displacement) {
  Vector result;
  problem.gaps(displacement, 0.0, result);
  return result;
}

RowBalance balance_of_row(const SemidiscreteProblem& problem, const ContactRows& rows, Index point,
                          const Vector& displacement) {
  const Index d = problem.dimension;
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  rows.visit_normal(point, [&](Index dof, double value) {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    place.head(d) = problem.nodes.col(dof / d) + displacement.segment(dof / d * d, d);
    const Eigen::Vector3d own = value * Eigen::Vector3d::Unit(dof % d);
    force += own;
    moment += place.cross(own);
  });
  return {force.norm(), moment.norm()};
}

Vector moved_rigidly(const SemidiscreteProblem& problem, const Vector& displacement) {
  const Index d = problem.dimension;
  Matrix turn = Matrix::Identity(d, d);
  turn.topLeftCorner(2, 2) << std::cos(2.0), -std::sin(2.0), std::sin(2.0), std::cos(2.0);
  if (d == 3) turn = Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix() * turn;
  Points moved = turn * (problem.nodes + displacement.reshaped(d, problem.nodes.cols()));
  moved.colwise() += Vector::LinSpaced(d, 1.0, 3.0);
  return Points(moved - problem.nodes).reshaped();
}

}  // namespace ricochet::test_support
