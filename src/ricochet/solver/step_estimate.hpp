#pragma once

#include <vector>

#include "ricochet/solver/step_solver.hpp"

/// @file What the stages of a step will take, from the symbolic analysis of their operators: seconds, where the
/// factorization takes minutes.
namespace ricochet {

/// Rates at which one core of a common machine works: additions and multiplications of a factorization, bytes of a
/// factor or of matrices read. The method of a solver is chosen by them (choose_method.hpp).
constexpr double estimated_operations_per_second = 3.0e10;
constexpr double estimated_bytes_per_second = 1.0e10;

struct StageEstimate {
  ChosenMethod chosen;
  Index unknowns = 0;
  double factor_bytes = 0.0;           ///< 0 of the iterative method
  double peak_bytes = 0.0;             ///< while the factor is made, with the matrix
  double factorization_seconds = 0.0;  ///< the ordering is done by then
  double iterations = 0.0;             ///< of a solve; 0 of the factor
  double step_seconds = 0.0;           ///< of the triangular solves, or of the iterations
  double bytes_per_point = 0.0;        ///< condensed columns of a contact point that may touch
};

/// Per operator; chooses the methods as make_step_solver does.
[[nodiscard]] std::vector<StageEstimate> estimate_step_solver(const SemidiscreteProblem& problem,
                                                              const std::vector<OperatorCoefficients>& operators,
                                                              const StepSolverOptions& options = {});

/// Seconds per step for the products with the matrices and the vectors beside the solves, with every scheme.
[[nodiscard]] double estimate_products(const SemidiscreteProblem& problem);

}  // namespace ricochet
