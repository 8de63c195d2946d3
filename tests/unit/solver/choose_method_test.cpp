#include "ricochet/solver/choose_method.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "ricochet/linear_algebra/block_jacobi.hpp"
#include "ricochet/simulation/simulation.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"
#include "ricochet/solver/stage/stage_product.hpp"
#include "ricochet/solver/step_estimate.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Direct or iterative: on both sides of every limit, and unchanged for the rest of a run.
namespace ricochet::test_support {
namespace {

constexpr double enough_memory = 1e15;

/// A factor of 10⁹ entries: 100 seconds to compute, 1.6 for the two reads of a solve; iterations take 3 seconds.
SparseCholesky::Prediction large_factor() { return {true, 1e9, 100.0 * estimated_operations_per_second}; }

IterationEstimate slow_iterations() { return {100.0, 0.03 * estimated_bytes_per_second}; }

ChosenMethod choose(const SparseCholesky::Prediction& predicted, long solves, double memory = enough_memory,
                    const OperatorCoefficients& coefficients = {1e6, 1.0, 0.0}) {
  StepSolverOptions options;
  options.memory = memory;
  options.solves = solves;
  return choose_method(predicted, coefficients, options, slow_iterations);
}

TEST(ChooseMethod, WeighsTheFactorizationAgainstTheSolves) {
  // 100 + 1.6 n compared with 3 n: direct from 72 solves on.
  EXPECT_EQ(choose(large_factor(), 1).method, SolverMethod::iterative);
  EXPECT_EQ(choose(large_factor(), 71).method, SolverMethod::iterative);
  EXPECT_EQ(choose(large_factor(), 72).method, SolverMethod::direct);
  EXPECT_EQ(choose(large_factor(), 100000).method, SolverMethod::direct);
  EXPECT_NE(choose(large_factor(), 71).reason.find("71 solves"), std::string::npos)
      << choose(large_factor(), 71).reason;
  EXPECT_EQ(choose(large_factor(), 71).expected_iterations, 100.0);
}

TEST(ChooseMethod, TakesAFactorForAnUnknownNumberOfSolves) {
  EXPECT_EQ(choose(large_factor(), 0).method, SolverMethod::direct);
  SparseCholesky::Prediction huge = large_factor();
  huge.operations = 1e15;
  EXPECT_EQ(choose(huge, 0).method, SolverMethod::iterative);
}

TEST(ChooseMethod, TakesAFactorThatIsMadeWithinSeconds) {
  SparseCholesky::Prediction small = large_factor();
  small.operations = 9.0 * estimated_operations_per_second;
  EXPECT_EQ(choose(small, 1).method, SolverMethod::direct);
  small.operations = 11.0 * estimated_operations_per_second;
  EXPECT_EQ(choose(small, 1).method, SolverMethod::iterative);
}

TEST(ChooseMethod, TakesAFactorWithoutInertia) {
  EXPECT_EQ(choose(large_factor(), 1, enough_memory, {0.0, 1.0, 0.0}).method, SolverMethod::direct);
}

TEST(ChooseMethod, IteratesWhereAFactorDoesNotFit) {
  EXPECT_EQ(choose(large_factor(), 100000, 8.1e9).method, SolverMethod::direct);
  EXPECT_EQ(choose(large_factor(), 100000, 7.9e9).method, SolverMethod::iterative);
  EXPECT_EQ(choose(large_factor(), 0, 7.9e9, {0.0, 1.0, 0.0}).method, SolverMethod::iterative);
  EXPECT_NE(choose(large_factor(), 1, 7.9e9).reason.find("8 GB, but only 7.9 GB are allowed"), std::string::npos)
      << choose(large_factor(), 1, 7.9e9).reason;
}

TEST(ChooseMethod, IteratesWhereNobodyCanCountAFactor) {
  const ChosenMethod chosen = choose({false, 3e9, 1e15}, 100000);
  EXPECT_EQ(chosen.method, SolverMethod::iterative);
  EXPECT_EQ(chosen.reason, "a factor would have 3e+09 entries, more than CHOLMOD can count");
}

TEST(ChooseMethod, DoesWhatItIsTold) {
  StepSolverOptions options;
  options.memory = 1.0;
  options.method = SolverMethod::direct;
  EXPECT_EQ(choose_method(large_factor(), {1e6, 1.0, 0.0}, options, slow_iterations).method, SolverMethod::direct);
  options.method = SolverMethod::iterative;
  EXPECT_EQ(choose_method(large_factor(), {1e6, 1.0, 0.0}, options, slow_iterations).method, SolverMethod::iterative);
  // An explicit step has few contact nodes.
  EXPECT_EQ(choose_method(large_factor(), {0.0, 1.0, 0.0, StageDofs::contact}, options, slow_iterations).method,
            SolverMethod::direct);
}

/// Number of conjugate gradient iterations for a force on all nodes.
int iterations_of(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, double tolerance) {
  const StageProduct product(problem, coefficients);
  const std::vector<char> solved(static_cast<std::size_t>(problem.dof_count()), 1);
  const auto preconditioner = make_block_jacobi(product.diagonal_blocks(), problem.dimension, solved);
  Vector residual =
      Vector::NullaryExpr(problem.dof_count(), [](Index i) { return std::sin(0.9 * double(i * i % 1013)); });
  Vector x = Vector::Zero(problem.dof_count());
  ConjugateGradients gradients;
  const double target = tolerance * gradients.norm(*preconditioner, residual);
  const auto result = gradients.solve([&](const Vector& a, Vector& b) { product.multiply(a, b); }, *preconditioner,
                                      target, 5000, residual, x);
  EXPECT_TRUE(result.converged);
  return result.iterations;
}

TEST(IterationEstimate, IsOfTheSizeOfTheCounts) {
  for (const ThrownBody& body : thrown_bodies()) {
    if (body.degree != 1) continue;
    for (const char* const mass : {"consistent", "equivalent"}) {
      CaseRun run(thrown_case(body, mass, time_of("newmark")));
      const SemidiscreteProblem& problem = run.problem();
      const double alpha = run.scheme().operators(problem).front().mass;
      // Multiples of the case's step: waves cross two cells, or the whole body.
      for (const double longer : {30.0, 100.0}) {
        const OperatorCoefficients coefficients{alpha / (longer * longer), 1.0, 0.0};
        const int counted = iterations_of(problem, coefficients, 1e-10);
        const IterationEstimate estimate = estimate_iterations(problem, coefficients, 1e-10);
        // Two free bodies, one of hexahedra, needed up to 3.6 times as many, for unknown reasons.
        const double most = body.against.empty() ? 2.0 : 4.0;
        EXPECT_GT(estimate.iterations, counted / most) << body.name << ' ' << mass << ' ' << longer;
        EXPECT_LT(estimate.iterations, counted * 2.0) << body.name << ' ' << mass << ' ' << longer;
      }
    }
  }
}

/// Laws of finite strain have the linear law's tangent at rest; a unit shear may invert their cells.
TEST(IterationEstimate, DoesNotDependOnTheLaw) {
  for (const ThrownBody& body : thrown_bodies()) {
    std::vector<double> iterations;
    for (const char* const law : {"linear", "neo-hookean"}) {
      CaseRun run(thrown_case(body, "equivalent", time_of("reduced-kane")),
                  {fmt::format("material.0.law=\"{}\"", law)});
      const OperatorCoefficients coefficients = run.scheme().operators(run.problem()).back();
      iterations.push_back(estimate_iterations(run.problem(), coefficients, 1e-10).iterations);
    }
    EXPECT_NEAR(iterations[1], iterations[0], 1e-6 * iterations[0]) << body.name;
  }
}

/// The choice at the start is kept, even if the rest of the run alone would lead to another one.
TEST(ChooseMethod, IsKeptByARunThatGoesOn) {
  for (const bool began_with_iterations : {true, false}) {
    CaseRun run(thrown_case(one_sided_block(), "equivalent", time_of("newmark"), "friction = 0.3\n"));
    StepSolverOptions little, much;
    little.memory = 1.0;
    much.memory = enough_memory;
    const StepSolverOptions& first = began_with_iterations ? little : much;
    const StepSolverOptions& later = began_with_iterations ? much : little;
    const SolverMethod method = began_with_iterations ? SolverMethod::iterative : SolverMethod::direct;
    Simulation whole(run.problem(), run.scheme(), run.model().initial, first);
    ASSERT_EQ(whole.methods().front().method, method);
    for (int k = 0; k < 20; ++k) whole.advance();
    Snapshot snapshot;
    whole.save(snapshot);
    Simulation resumed(run.problem(), run.scheme(), snapshot, later);
    EXPECT_EQ(resumed.methods().front().method, method);
    for (int k = 0; k < 20; ++k) {
      whole.advance();
      resumed.advance();
    }
    EXPECT_EQ(resumed.state().displacement, whole.state().displacement);
  }
}

}  // namespace
}  // namespace ricochet::test_support
