#include "ricochet/linear_algebra/single_precision_cg.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/block_jacobi.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

namespace ricochet::test_support::single_gradients_test {

/// An operator αM + K of a thrown body, with rows that are not solved for.
struct Problem {
  SparseMatrix matrix;
  int d;
  std::vector<char> solved;
  Vector force;
};

std::vector<Problem> problems() {
  std::vector<Problem> result;
  for (const ThrownBody& body : thrown_bodies()) {
    CaseRun run(thrown_case(body, "consistent", time_of("newmark")));
    const double alpha = run.scheme().operators(run.problem()).front().mass;
    Problem& problem = result.emplace_back();
    problem.matrix = combine_operator(run.problem(), {alpha / 400.0, 1.0, 0.0});
    problem.d = run.problem().dimension;
    problem.solved.assign(std::size_t(problem.matrix.cols()), 1);
    for (std::size_t dof = 5; dof < problem.solved.size(); dof += 7) problem.solved[dof] = 0;
    problem.force =
        Vector::NullaryExpr(problem.matrix.cols(), [](Index i) { return 1e6 * std::sin(0.9 * double(i * i % 1013)); });
    for (Index dof = 0; dof < problem.force.size(); ++dof) {
      if (problem.solved[std::size_t(dof)] == 0) problem.force[dof] = 0.0;
    }
  }
  return result;
}

Vector masked_product(const Problem& problem, const Vector& x) {
  Vector y = problem.matrix * x;
  for (Index dof = 0; dof < y.size(); ++dof) {
    if (problem.solved[std::size_t(dof)] == 0) y[dof] = 0.0;
  }
  return y;
}

TEST(SinglePrecisionCg, ReachDoublePrecisionInRounds) {
  for (const Problem& problem : problems()) {
    const NodeMatrix matrix(problem.matrix, problem.d);
    ASSERT_FALSE(matrix.is_scalar());
    SinglePrecisionCg single(matrix, matrix.diagonal_blocks(), problem.solved);
    const auto blocks = make_block_jacobi(matrix.diagonal_blocks(), problem.d, problem.solved);
    ConjugateGradients gradients;
    Vector x = Vector::Zero(problem.force.size()), residual = problem.force;
    const double begin = gradients.norm(*blocks, residual);
    for (int round = 0; round < 3; ++round) {
      const double norm = gradients.norm(*blocks, residual);
      const ConjugateGradients::Result result = single.solve(residual, 1e-4, 5000, x);
      EXPECT_TRUE(result.converged);
      residual = problem.force - masked_product(problem, x);
      // The reported residual is in the same norm, and correct.
      EXPECT_LE(result.residual, 1.001e-4 * norm);
      EXPECT_LT(gradients.norm(*blocks, residual), 2e-4 * norm);
    }
    EXPECT_LT(gradients.norm(*blocks, residual), 1e-11 * begin);
    for (Index dof = 0; dof < x.size(); ++dof) {
      const bool is_solved = problem.solved[std::size_t(dof)] != 0;
      EXPECT_TRUE(is_solved || x[dof] == 0.0);
    }
  }
}

/// Nearly as many iterations as in double precision.
TEST(SinglePrecisionCg, TakeTheIterationsOfDiagonalBlocks) {
  for (const Problem& problem : problems()) {
    const NodeMatrix matrix(problem.matrix, problem.d);
    SinglePrecisionCg single(matrix, matrix.diagonal_blocks(), problem.solved);
    const auto blocks = make_block_jacobi(matrix.diagonal_blocks(), problem.d, problem.solved);
    ConjugateGradients gradients;
    Vector x = Vector::Zero(problem.force.size()), residual = problem.force;
    const int found = single.solve(residual, 1e-5, 5000, x).iterations;
    x.setZero();
    const double target = 1e-5 * gradients.norm(*blocks, residual);
    const auto product = [&](const Vector& a, Vector& b) { b = masked_product(problem, a); };
    const int expected = gradients.solve(product, *blocks, target, 5000, residual, x).iterations;
    EXPECT_NEAR(found, expected, 1 + expected / 20);
  }
}

TEST(SinglePrecisionCg, AreTheSameBitsForAnyNumberOfThreads) {
  const Problem problem = problems().back();
  const NodeMatrix matrix(problem.matrix, problem.d);
  SinglePrecisionCg single(matrix, matrix.diagonal_blocks(), problem.solved);
  Vector one = Vector::Zero(problem.force.size()), three = one;
  single.solve(problem.force, 1e-5, 5000, one);
  set_thread_count(3);
  single.solve(problem.force, 1e-5, 5000, three);
  set_thread_count(1);
  EXPECT_EQ(one, three);
}

/// Numbers near the limits of single precision: the scaled matrix and residual are independent of units.
TEST(SinglePrecisionCg, DoNotKnowUnits) {
  const Problem problem = problems().front();
  const NodeMatrix matrix(problem.matrix, problem.d);
  Vector usual = Vector::Zero(problem.force.size());
  SinglePrecisionCg(matrix, matrix.diagonal_blocks(), problem.solved).solve(problem.force, 1e-5, 5000, usual);
  for (const double unit : {1e-60, 1e60}) {
    const NodeMatrix other(SparseMatrix(unit * problem.matrix), problem.d);
    Vector x = Vector::Zero(problem.force.size());
    const auto result = SinglePrecisionCg(other, other.diagonal_blocks(), problem.solved)
                            .solve(Vector(1e-100 * problem.force), 1e-5, 5000, x);
    EXPECT_TRUE(result.converged);
    EXPECT_LT((x * (1e100 * unit) - usual).norm(), 1e-4 * usual.norm());
  }
}

TEST(SinglePrecisionCg, SayWhereAMatrixIsNotPositiveDefinite) {
  const Problem problem = problems().front();
  const NodeMatrix matrix(SparseMatrix(-problem.matrix), problem.d);
  Vector x = Vector::Zero(problem.force.size());
  EXPECT_FALSE(SinglePrecisionCg(matrix, matrix.diagonal_blocks(), problem.solved)
                   .solve(problem.force, 1e-5, 5000, x)
                   .converged);
}

TEST(SinglePrecisionCg, LeaveXAloneWithoutAResidual) {
  const Problem problem = problems().front();
  const NodeMatrix matrix(problem.matrix, problem.d);
  Vector x = Vector::Ones(problem.force.size());
  const auto result =
      SinglePrecisionCg(matrix, matrix.diagonal_blocks(), problem.solved).solve(Vector::Zero(x.size()), 1e-5, 5000, x);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(x, Vector(Vector::Ones(x.size())));
}

}  // namespace ricochet::test_support::single_gradients_test
