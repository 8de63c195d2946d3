#include "ricochet/fclib/fclib_file.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "support/errors.hpp"
#include "support/fclib_support.hpp"

namespace ricochet::test_support {
namespace {

void expect_equal(const FclibProblem& a, const FclibProblem& b) { EXPECT_TRUE(same(a, b)); }

// Round trips.

TEST(FclibFile, RoundTripInEveryFormAndDimension) {
  const TemporaryFile file;
  for (const Index dimension : {2, 3}) {
    for (const Index constraints : {0, 4}) {
      const FclibProblem problem = example(dimension, 5, constraints);
      for (const auto form :
           {FclibMatrixForm::triplet, FclibMatrixForm::compressed_columns, FclibMatrixForm::compressed_rows}) {
        write_fclib(file.path, problem, form);
        expect_equal(read_fclib(file.path), problem);
      }
    }
  }
}

TEST(FclibFile, ManyEntriesGoIntoChunks) {
  const TemporaryFile file;
  const FclibProblem problem = example(3, 150, 0);  // 450² entries, more than one chunk
  write_fclib(file.path, problem);
  expect_equal(read_fclib(file.path), problem);
  const FclibReduction reduction = reduce(problem);
  ASSERT_NE(reduction.problem.contact_operator->dense(), nullptr);
}

TEST(FclibFile, TheSameDataGiveTheSameFile) {
  const TemporaryFile one, other;
  write_fclib(one.path, example(3, 5, 2));
  write_fclib(other.path, example(3, 5, 2));
  EXPECT_EQ(contents(one.path), contents(other.path));
}

TEST(FclibFile, NoPointsAtAll) {
  const TemporaryFile file;
  FclibProblem problem = example(2, 0, 0);
  problem.points.clear();
  write_fclib(file.path, problem);
  expect_equal(read_fclib(file.path), problem);
  EXPECT_EQ(reduce(problem).problem.points(), 0);
}

TEST(FclibFile, DuplicatesAreSummedAndOrderDoesNotMatter) {
  const TemporaryFile file;
  Raw raw = raw_example();
  raw.reals["/fclib_local/W/x"] = {1.0, 2.0, 3.0, 0.5, 0.5};
  raw.integers["/fclib_local/W/p"] = {1, 0, 0, 0, 1};
  raw.integers["/fclib_local/W/i"] = {1, 0, 0, 1, 0};
  raw.write(file.path);
  Matrix expected(2, 2);
  expected << 5.0, 0.5, 0.5, 1.0;
  EXPECT_EQ(Matrix(read_fclib(file.path).w), expected);
}

TEST(FclibFile, RoundingInTheSymmetryOfWIsTakenOut) {
  const TemporaryFile file;
  Raw raw = raw_example();
  raw.reals["/fclib_local/W/x"] = {2.0, 1.0, 1.0 + 1e-12, 3.0, 0.0};
  raw.write(file.path);
  const Matrix w(read_fclib(file.path).w);
  EXPECT_EQ(w(0, 1), w(1, 0));
  EXPECT_NEAR(w(0, 1), 1.0, 1e-12);
}

TEST(FclibFile, SparseAndDenseOperators) {
  FclibProblem problem = example(3, 20, 0);
  EXPECT_NE(reduce(problem).problem.contact_operator->dense(), nullptr);
  problem.w.setIdentity();
  EXPECT_NE(reduce(problem).problem.contact_operator->sparse(), nullptr);
}

// Equality constraints.

TEST(FclibFile, EqualityConstraintsAreEliminated) {
  // Constraint units that differ by many orders of magnitude have no effect.
  for (const double unit : {1.0, 0x1p-100}) {
    FclibProblem problem = example(3, 4, 3);
    Vector scale(3);
    scale << 1.0, unit, 1.0 / 0x1p30;
    problem.v = problem.v * scale.asDiagonal();
    problem.r = scale.asDiagonal() * problem.r * scale.asDiagonal();
    problem.s = scale.asDiagonal() * problem.s;
    const FclibReduction reduction = reduce(problem);
    std::mt19937 random(5);
    ContactSolution found;
    found.reaction = uniform(12, random);
    reduction.problem.contact_operator->multiply(found.reaction, found.motion);
    found.motion += reduction.problem.offset;
    const FclibSolution whole = reduction.solution(found);
    // Direct solution: unknowns λ from Vᵀ r + R λ + s = 0, then u = W r + V λ + q.
    const Vector multiplier =
        Matrix(problem.r).partialPivLu().solve(-(problem.v.transpose() * whole.reaction + problem.s));
    const Vector motion = problem.w * whole.reaction + problem.v * whole.multiplier + problem.q;
    EXPECT_LT((scale.cwiseProduct(whole.multiplier - multiplier)).norm(),
              1e-12 * scale.cwiseProduct(multiplier).norm());
    EXPECT_LT((motion - whole.motion).norm(), 1e-12 * motion.norm());
    const Matrix* const w = reduction.problem.contact_operator->dense();
    ASSERT_NE(w, nullptr);
    EXPECT_EQ(*w, w->transpose());
  }
}

TEST(FclibFile, ConstraintsThatDependOnOneAnother) {
  FclibProblem problem = example(3, 4, 3);
  Matrix r(problem.r);
  r.col(2) = r.col(1);
  r.row(2) = r.row(1);
  problem.r = r.sparseView();
  expect_error({"is singular, of rank 2 with 3 constraints"}, [&] { (void)reduce(problem); });
}

// From the contact problem of a step.

TEST(FclibFile, OnlyEligiblePointsAndTangentsForAll) {
  std::mt19937 random(1);
  ContactProblem problem;
  problem.row_offset = {0, 1, 4, 7, 8};  // points 0 and 3 have no friction
  const Matrix w = random_operator(8, random);
  problem.contact_operator = make_dense_operator(w);
  problem.offset = uniform(8, random);
  problem.friction_coefficient.resize(4);
  problem.friction_coefficient << 0.0, 0.3, 0.4, 0.0;
  problem.eligible = {1, 0, 1, 1};
  problem.offset_rounding = uniform(8, random).cwiseAbs();
  ContactSolution solution;
  solution.reaction = uniform(8, random);
  solution.motion = uniform(8, random);
  solution.outcome = ContactOutcome::solved;
  const FclibProblem made = make_fclib(problem, 3, &solution);
  EXPECT_EQ(made.points, (std::vector<Index>{0, 2, 3}));
  EXPECT_EQ(made.mu, Eigen::Vector3d(0.0, 0.4, 0.0));
  EXPECT_TRUE(has(made.description, "2 of 3 points have no friction"));
  const Index old_row[] = {0, -1, -1, 4, 5, 6, 7, -1, -1};
  const Matrix found(made.w);
  for (Index i = 0; i < 9; ++i) {
    EXPECT_EQ(made.q[i], old_row[i] >= 0 ? problem.offset[old_row[i]] : 0.0);
    EXPECT_EQ(made.q_rounding[i], old_row[i] >= 0 ? problem.offset_rounding[old_row[i]] : 0.0);
    EXPECT_EQ(made.solution->reaction[i], old_row[i] >= 0 ? solution.reaction[old_row[i]] : 0.0);
    EXPECT_EQ(made.solution->motion[i], old_row[i] >= 0 ? solution.motion[old_row[i]] : 0.0);
    for (Index j = 0; j < 9; ++j) {
      double expected = old_row[i] >= 0 && old_row[j] >= 0 ? w(old_row[i], old_row[j]) : 0.0;
      if (i == j && old_row[i] < 0) expected = w(old_row[i - i % 3], old_row[i - i % 3]);
      EXPECT_EQ(found(i, j), expected) << i << ' ' << j;
    }
  }
  EXPECT_EQ(reduce(made).problem.offset_rounding, made.q_rounding);
  // The same problem from a sparse W, and from its product alone.
  for (const auto& other :
       {make_sparse_operator(w.sparseView()), make_product_operator(8, [&](const Vector&x, Vector&y) { y = w * x; })}) {
    problem.contact_operator = other;
    EXPECT_EQ(Matrix(make_fclib(problem, 3).w), found);
  }
}

TEST(FclibFile, WhatIsNotSolvedIsNoSolution) {
  const ContactProblem problem(2, Matrix::Identity(4, 4), Vector::Constant(4, -1.0), 0.5);
  ContactSolution solution;
  solution.reaction = solution.motion = Vector::Ones(4);
  solution.outcome = ContactOutcome::not_converged;
  solution.reason = "it would not";
  FclibProblem made = make_fclib(problem, 2, &solution);
  EXPECT_FALSE(made.solution.has_value());
  ASSERT_EQ(made.guesses.size(), 1u);
  EXPECT_EQ(made.guesses.front().reaction, solution.reaction);
  EXPECT_TRUE(has(made.math_info, "NOT SOLVED (it would not)"));
  solution.outcome = ContactOutcome::solved;
  put_solution(made, made.guesses.front(), solution);
  EXPECT_TRUE(made.solution.has_value());
  EXPECT_TRUE(made.guesses.empty());
  EXPECT_FALSE(has(made.math_info, "NOT SOLVED"));
}

TEST(FclibFile, WhatTheFormatCannotSayIsAnError) {
  ContactProblem problem(3, Matrix::Identity(6, 6), Vector::Zero(6), 0.5);
  expect_error({"point 0 has 3 rows"}, [&] { (void)make_fclib(problem, 2); });
  problem.friction_bound.setZero(2);
  problem.friction_bound[1] = 2.0;
  expect_error({"point 1 has a friction bound (2)"}, [&] { (void)make_fclib(problem, 3); });
  problem.eligible = {1, 0};
  EXPECT_EQ(make_fclib(problem, 3).point_count(), 1);
}

TEST(FclibFile, AFileThatCannotBeWrittenLeavesNothing) {
  expect_error(ErrorKind::file_access, {"/no/such/directory/file.hdf5: cannot be written"},
               [] { write_fclib("/no/such/directory/file.hdf5", example(2, 1, 0)); });
}

}  // namespace
}  // namespace ricochet::test_support
