#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "ricochet/base/error.hpp"
#include "support/contact_solver_test.hpp"

/// @file Behaviour of every solver of the library for data and options that are invalid or at the limits.
namespace ricochet::test_support {
namespace {

class ContactSolverData : public ContactSolverTest {};

TEST_P(ContactSolverData, RefuseNumbersThatAreNone) {
  const FrictionProblem sound = random_problem(10, dimension(), 0.3, 1);
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    FrictionProblem problem = sound;
    problem.q[3] = value;
    ContactSolution solution = solve(problem, {.tolerance = 1e-8});
    EXPECT_EQ(solution.outcome, ContactOutcome::invalid_data);
    EXPECT_NE(solution.reason, "");
    problem = sound;
    problem.w.triangularView<Eigen::StrictlyUpper>().setConstant(value);
    problem.w.triangularView<Eigen::StrictlyLower>().setConstant(value);
    solution = solve(problem, {.tolerance = 1e-8});
    EXPECT_FALSE(solution.solved());
    EXPECT_NE(solution.reason, "");
  }
}

TEST_P(ContactSolverData, RefuseOperatorsWithNumbersThatAreNone) {
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (const double friction : {0.0, 0.3}) {
      for (const auto& [i, j] : {std::pair<Index, Index>{1, 2}, {0, 5}, {3, 3}, {0, 3}}) {
        FrictionProblem problem = random_problem(6, 2, friction, 3, 1.0);
        for (Index k = 0; k < problem.points(); ++k) problem.q[problem.row_offset[std::size_t(k)]] = -1.0;
        problem.w(i, j) = problem.w(j, i) = value;
        const ContactSolution solution = solve(problem, {.tolerance = 1e-8});
        EXPECT_EQ(solution.outcome, ContactOutcome::invalid_data) << i << ' ' << j << ' ' << friction;
      }
    }
  }
  FrictionProblem negative = random_problem(6, 2, 0.3, 3, 1.0);
  negative.w(4, 4) = -1.0;
  EXPECT_EQ(solve(negative, {}).outcome, ContactOutcome::invalid_data);
}

TEST_P(ContactSolverData, RefuseSizesAndOptionsThatDoNotFit) {
  const ContactProblem problem = random_problem(40, dimension(), 0.3, 3, 1.0).contact();
  const auto solver = make_contact_solver(GetParam());
  solver->analyse(problem);
  ContactSolution solution;
  const auto expect_refused = [&](const auto& change, const ContactOptions& options) {
    ContactProblem changed = problem;
    change(changed);
    EXPECT_THROW(solver->solve(changed, options, solution), Error);
  };
  const auto nothing = [](ContactProblem&) {};
  expect_refused([](ContactProblem& p) { p.offset.conservativeResize(5); }, {});
  expect_refused([](ContactProblem& p) { p.friction_coefficient.conservativeResize(2); }, {});
  expect_refused([](ContactProblem& p) { p.friction_coefficient[0] = -1.0; }, {});
  expect_refused([](ContactProblem& p) { p.friction_coefficient[0] = std::nan(""); }, {});
  expect_refused([](ContactProblem& p) { p.eligible = {1}; }, {});
  expect_refused([](ContactProblem& p) { p.row_offset[1] = 1; }, {});
  expect_refused(nothing, {.tolerance = std::nan("")});
  expect_refused(nothing, {.tolerance = -1.0});
  expect_refused(nothing, {.tolerance = 1.0});
  expect_refused(nothing, {.iteration_limit = -1});
  EXPECT_THROW(solver->set_warm_start(Vector::Ones(7)), Error);
  EXPECT_THROW(solver->set_warm_start(Vector::Constant(problem.rows(), std::nan(""))), Error);
  EXPECT_THROW(solver->set_warm_start(Vector::Ones(problem.rows() + 1)), Error);
  solver->set_warm_start(Vector::Ones(problem.rows()));
  solver->solve(problem, {}, solution);
  EXPECT_TRUE(solution.solved());
}

/// A checkpoint of another program, version or problem is refused, and the solver then starts cold.
TEST_P(ContactSolverData, RefuseMemoriesThatAreNotTheirs) {
  // The rows of the points: 0 to 2, 3, 4 to 6 (or one less for those with two).
  FrictionProblem data({dimension(), 1, dimension()}, 0.3);
  data.q.setConstant(-1.0);
  const ContactProblem problem = data.contact();
  const ContactOptions options{.tolerance = 1e-10};
  const auto solver = make_contact_solver(GetParam());
  solver->analyse(problem);
  ContactSolution cold, solution;
  solver->solve(problem, options, cold);
  ASSERT_TRUE(cold.solved()) << cold.reason;
  Snapshot saved;
  solver->persist(saved.saver("solver"));
  const auto second = Index(dimension());
  const auto with = [&](const std::map<std::string, Snapshot::Value>& changes) {
    Snapshot changed = saved;
    for (const auto& [name, value] : changes) changed.set("solver." + name, value);
    return changed;
  };
  const auto expect_refused = [&](const std::string& what, const std::map<std::string, Snapshot::Value>& changes) {
    SCOPED_TRACE(what);
    solver->persist(saved.loader("solver"));
    EXPECT_THROW(solver->persist(with(changes).loader("solver")), Error);
    solver->solve(problem, options, solution);
    EXPECT_EQ(solution.reaction, cold.reaction);
    EXPECT_EQ(solution.iterations, cold.iterations);
  };
  using Integers = Snapshot::Integers;
  expect_refused("too few reactions", {{"reactions", Vector(Vector::Ones(problem.rows() - 1))}});
  expect_refused("no numbers", {{"reactions", Vector(Vector::Constant(problem.rows(), std::nan("")))}});
  expect_refused("another kind", {{"reactions", Integers{1, 2}}});
  const auto unknowns = [](Integers rows, Integers sizes) {
    const Vector one = (Vector(7) << 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0).finished();
    const Vector values = one.replicate(Index(rows.size()), 1);
    return std::map<std::string, Snapshot::Value>{
        {"unknowns.rows", rows}, {"unknowns.sizes", sizes}, {"unknowns.values", values}};
  };
  const bool keeps_costs = saved.has("solver.costs"), keeps_factor = saved.has("solver.unknowns.rows");
  if (keeps_factor) {
    for (const Index row : {Index{-1}, Index{1}, problem.rows(), std::numeric_limits<Index>::max()})
      expect_refused(fmt::format("row {}", row), unknowns({row}, {1}));
    for (const Index size : {-1, 0, 4}) expect_refused(fmt::format("size {}", size), unknowns({0}, {size}));
    expect_refused("a point with one row", unknowns({second}, {2}));
    expect_refused("not in order", unknowns({second, 0}, {1, 1}));
    expect_refused("a size is missing", unknowns({0, second}, {1}));
    expect_refused("a value is missing", {{"unknowns.values", Vector(Vector::Ones(6))}});
    solver->persist(with(unknowns({second}, {1})).loader("solver"));
  }
  if (keeps_costs) {
    expect_refused("one cost", {{"costs", Vector(Vector::Ones(1))}});
    expect_refused("a negative cost", {{"costs", Vector(Vector::Constant(2, -1.0))}});
    for (const Index row : {Index{-1}, Index{1}, problem.rows(), std::numeric_limits<Index>::max()})
      expect_refused(fmt::format("active row {}", row), {{"active_set", Integers{row}}});
    expect_refused("twice", {{"active_set", Integers{0, 0}}});
    expect_refused("not in order", {{"active_set", Integers{second, 0}}});
    solver->persist(with({{"active_set", Integers{0, second}}}).loader("solver"));
  }
  // Its own memory is accepted.
  solver->solve(problem, options, solution);
  EXPECT_TRUE(solution.solved());
}

/// Also if the solver has not solved anything yet.
TEST_P(ContactSolverData, TakeTheMemoryTheySave) {
  for (const Index points : {1, 2, 30}) {
    const ContactProblem problem = random_problem(points, dimension(), 0.3, 2).contact();
    const auto solver = make_contact_solver(GetParam());
    EXPECT_EQ(solver->warm_start().size(), 0);
    const auto other = make_contact_solver(GetParam());
    solver->analyse(problem);
    other->analyse(problem);
    ContactSolution solution, expected;
    for (int k = 0; k < 2; ++k) {
      Snapshot saved;
      solver->persist(saved.saver("solver"));
      other->persist(saved.loader("solver"));
      solver->solve(problem, {.tolerance = 1e-6}, expected);
      other->solve(problem, {.tolerance = 1e-6}, solution);
      EXPECT_EQ(solution.reaction, expected.reaction);
      EXPECT_EQ(solution.iterations, expected.iterations);
    }
  }
}

/// Squares of such numbers leave the range of numbers; the problem does not.
TEST_P(ContactSolverData, SolveDataOfAnySize) {
  const FrictionProblem problem = random_problem(12, dimension(), 0.3, 3, 1.0);
  const ContactSolution expected = solve(problem, {.tolerance = 1e-10});
  ASSERT_TRUE(expected.solved());
  const std::pair<double, double> factors[] = {{0x1p990, 0x1p990},   {1.0, 0x1p530},  {1.0, 0x1p-990},
                                               {0x1p-990, 0x1p-980}, {0x1p-990, 1.0}, {0x1p600, 1.0}};
  for (const auto& [of_operator, of_offset] : factors) {
    FrictionProblem other = problem;
    other.w *= of_operator;
    other.q *= of_offset;
    const ContactSolution solution = solve(other, {.tolerance = 1e-10});
    EXPECT_TRUE(solution.solved()) << of_operator << ' ' << of_offset << ": " << solution.reason;
    EXPECT_EQ(solution.reaction, expected.reaction * (of_offset / of_operator)) << of_operator << ' ' << of_offset;
  }
  FrictionProblem beyond = problem;  // reactions of 2^1100
  beyond.w *= 0x1p-600;
  beyond.q *= 0x1p500;
  const ContactSolution solution = solve(beyond, {.tolerance = 1e-10});
  EXPECT_FALSE(solution.solved());
  EXPECT_NE(solution.reason.find("range of floating-point numbers"), std::string::npos) << solution.reason;
}

/// For large F the residual of the cone hardly measures a penetration: it is 1/F times it.
TEST_P(ContactSolverData, DoNotTakePenetrationForRounding) {
  for (const double friction : {1e6, 1e7, 1e9}) {
    for (unsigned seed = 0; seed < seeds(10); ++seed) {
      const FrictionProblem problem = random_problem(10, dimension(), friction, seed, 1.0);
      // Solvers that succeed need fewer than 50 iterations; the cone alone does not suffice in 50 000.
      const ContactSolution solution = solve(problem, {.tolerance = 1e-8, .iteration_limit = 200});
      if (!solution.solved()) continue;
      const Vector u = problem.q + problem.w * solution.reaction;
      for (Index i = 0; i < problem.points(); ++i)
        EXPECT_GE(u[problem.row_offset[std::size_t(i)]], -0.02 * problem.q.lpNorm<Eigen::Infinity>())
            << friction << ' ' << seed;
    }
  }
}

/// Two points, each of which presses the other down.
TEST_P(ContactSolverData, DoNotSolveWhatHasNoSolution) {
  FrictionProblem problem({1, 1}, 0.0);
  problem.w << 1.0, -2.0, -2.0, 1.0;
  problem.q << -1.0, -1.0;
  const ContactSolution solution = solve(problem, {.tolerance = 1e-8, .iteration_limit = 500});
  EXPECT_FALSE(solution.solved());
  EXPECT_NE(solution.reason, "");
}

INSTANTIATE_TEST_SUITE_P(All, ContactSolverData, every_contact_solver(), contact_solver_test_name);

}  // namespace
}  // namespace ricochet::test_support
