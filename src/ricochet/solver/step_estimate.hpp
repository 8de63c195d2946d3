#pragma once

#include <vector>

#include "ricochet/solver/step_solver.hpp"

/// @file Estimated cost of the stages of a step, from the symbolic analysis of their operators: it takes seconds where
/// the factorization takes minutes.
namespace ricochet {

/// Rates of one core of a common machine: additions and multiplications of a factorization; bytes read of a factor or
/// of matrices. They determine the method of a solver (choose_method.hpp).
constexpr double estimated_operations_per_second = 3.0e10;
constexpr double estimated_bytes_per_second = 1.0e10;

struct StageEstimate {
  ChosenMethod chosen;
  Index unknowns = 0;
  double factor_bytes = 0.0;           ///< 0 for the iterative method
  double peak_bytes = 0.0;             ///< while the factor is computed, including the matrix
  double factorization_seconds = 0.0;  ///< without the ordering
  double iterations = 0.0;             ///< per solve; 0 with a factor
  double step_seconds = 0.0;           ///< of the triangular solves or the iterations
  double bytes_per_point = 0.0;        ///< of condensed columns, per contact point that may touch
};

/// Estimates each operator; chooses methods as make_step_solver does.
[[nodiscard]] std::vector<StageEstimate> estimate_step_solver(const SemidiscreteProblem& problem,
                                                              const std::vector<OperatorCoefficients>& operators,
                                                              const StepSolverOptions& options = {});

/// Seconds that a step of any scheme spends on products with matrices and on vectors, besides the solves.
[[nodiscard]] double estimate_products(const SemidiscreteProblem& problem);

}  // namespace ricochet
