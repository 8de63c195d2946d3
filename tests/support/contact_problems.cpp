#include "support/contact_problems.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet::test_support {

FrictionProblem::FrictionProblem(const std::vector<Index>& sizes, double friction) {
  for (const Index size : sizes) row_offset.push_back(row_offset.back() + size);
  q.setZero(row_offset.back());
  rounding.setZero(row_offset.back());
  w.setIdentity(row_offset.back(), row_offset.back());
  coefficient.setConstant(points(), friction);
  bound.setZero(points());
  eligible.assign(sizes.size(), 1);
}

ContactProblem FrictionProblem::contact(std::shared_ptr<const ContactOperator> contact_operator) const {
  ContactProblem problem;
  problem.contact_operator = contact_operator != nullptr ? std::move(contact_operator) : make_dense_operator(w);
  problem.offset = q;
  problem.offset_rounding = rounding;
  problem.row_offset = row_offset;
  problem.eligible = eligible;
  problem.friction_coefficient = coefficient;
  problem.friction_bound = bound;
  return problem;
}

Matrix random_operator(Index size, double digits, std::mt19937& random) {
  Matrix square(size, size);
  for (Index j = 0; j < size; ++j) square.col(j) = uniform(size, random);
  const Matrix basis = Eigen::HouseholderQR<Matrix>(square).householderQ();
  Vector values(size);
  for (Index i = 0; i < size; ++i)
    values[i] = std::pow(10.0, -digits * double(i) / double(std::max<Index>(size - 1, 1)));
  Matrix w = basis * values.asDiagonal() * basis.transpose();
  w.triangularView<Eigen::StrictlyUpper>() = w.transpose();
  return w;
}

FrictionProblem random_problem(Index points, Index dimension, double friction, unsigned seed, double digits) {
  std::mt19937 random(seed);
  std::vector<Index> sizes;
  for (Index i = 0; i < points; ++i) sizes.push_back(random() % 5 == 0 ? 1 : dimension);
  FrictionProblem problem(sizes, friction);
  problem.w = random_operator(problem.row_offset.back(), digits, random);
  problem.q = uniform(problem.row_offset.back(), random);
  return problem;
}

FrictionProblem half_space_problem(Index side, double friction) {
  FrictionProblem problem(std::vector<Index>(std::size_t(side * side), 3), friction);
  const double spacing = 1.0 / double(side);
  const auto place = [&](Index i) -> Eigen::Vector2d {
    return {(0.5 + double(i % side)) * spacing - 0.5, (0.5 + double(i / side)) * spacing - 0.5};
  };
  for (Index i = 0; i < side * side; ++i) {
    for (Index j = 0; j < side * side; ++j) {
      const Eigen::Vector2d apart = place(i) - place(j);
      const double kernel = std::exp(-4.0 * apart.norm());
      Eigen::Matrix3d block = Eigen::Vector3d(1.0, 1.3, 1.3).asDiagonal();
      block *= kernel;
      block.block<1, 2>(0, 1) += 0.6 * kernel * apart.transpose();
      block.block<2, 1>(1, 0) -= 0.6 * kernel * apart;
      problem.w.block<3, 3>(3 * i, 3 * j) = block;
    }
    const Eigen::Vector2d x = place(i);
    problem.q[3 * i] = 2.5 * x.squaredNorm() - 0.4;
    problem.q[3 * i + 1] = 0.08 - 0.1 * x[1];
    problem.q[3 * i + 2] = 0.02 + 0.1 * x[0];
  }
  return problem;
}

const ContactSolution& ContactRun::solve(const FrictionProblem& problem, const ContactOptions& options) {
  if (operator_ == nullptr) {
    operator_ = make_dense_operator(problem.w);
    solver_->analyse(problem.contact(operator_));
    solver_->set_warm_start(start_reactions_);
    if (start_) solver_->persist(start_->loader("solver"));
  }
  solver_->solve(problem.contact(operator_), options, solution_);
  return solution_;
}

ContactSolution solve(const FrictionProblem& problem, const ContactOptions& options, const std::string& name) {
  return ContactRun(name).solve(problem, options);
}

void expect_law(const FrictionProblem& problem, const ContactSolution& solution, double tolerance) {
  ASSERT_TRUE(solution.solved()) << solution.reason << ", residual " << solution.residual;
  EXPECT_LE(solution.residual, 1e-12 + solution.rounding_floor);
  const Vector& rho = solution.reaction;
  ASSERT_EQ(rho.size(), problem.q.size());
  const Vector u = problem.q + problem.w * rho;
  const Vector size = problem.q.cwiseAbs() + problem.w.cwiseAbs() * rho.cwiseAbs();
  for (Index i = 0; i < problem.points(); ++i) {
    SCOPED_TRACE(testing::Message() << "point " << i);
    const auto at = std::size_t(i);
    const Index row = problem.row_offset[at];
    const Index tangents = problem.row_offset[at + 1] - row - 1;
    const ContactStatus status = solution.status[at];
    const auto force = rho.segment(row + 1, tangents);
    const auto slip = u.segment(row + 1, tangents);
    const double rounding = tolerance * (size.segment(row, tangents + 1).maxCoeff() + problem.q.cwiseAbs().maxCoeff());
    if (problem.eligible[at] == 0 || status == ContactStatus::open) {
      EXPECT_EQ(rho.segment(row, tangents + 1).cwiseAbs().sum(), 0.0);
      EXPECT_EQ(status, ContactStatus::open);
      if (problem.eligible[at] != 0) {
        EXPECT_GE(u[row], -rounding);
      }
      continue;
    }
    EXPECT_GE(rho[row], 0.0);
    EXPECT_LE(std::abs(u[row]), rounding);
    double limit = tangents == 0 ? 0.0 : problem.coefficient[i] * rho[row];
    if (tangents > 0 && problem.bound[i] > 0.0) {
      limit = problem.coefficient[i] > 0.0 ? std::min(limit, problem.bound[i]) : problem.bound[i];
    }
    EXPECT_LE(force.norm(), limit * (1.0 + 4.0 * std::numeric_limits<double>::epsilon()));
    if (limit == 0.0) {
      EXPECT_EQ(status, ContactStatus::closed);
    } else if (status == ContactStatus::stick) {
      EXPECT_LE(slip.norm(), rounding);
    } else {
      EXPECT_EQ(status, ContactStatus::slip);
      if (problem.bound[i] == 0.0 || rho[row] > 0.0) {
        EXPECT_GE(force.norm(), limit * (1.0 - 4.0 * std::numeric_limits<double>::epsilon()));
      }
      // |r_T| u_T + |u_T| ρ_T = 0, per unit of force.
      EXPECT_LE((slip + slip.norm() / force.norm() * force).norm(), 2.0 * rounding);
      EXPECT_LE(force.dot(slip), 0.0);
    }
  }
}

}  // namespace ricochet::test_support
