#pragma once

#include <functional>

#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file Choice between a direct and an iterative solver for the stages of one operator. It compares counts at fixed
/// rates, never measured times: the choice decides bits, and is the same on every machine that has the memory.
namespace ricochet {

/// Cost of an iterative solve.
struct IterationEstimate {
  double iterations = 0.0;  ///< of conjugate gradients on the whole body
  double bytes = 0.0;       ///< read and written in each
};

/// Estimates conjugate gradients with the diagonal blocks D of A = αM + κK as preconditioner, down to this part of the
/// initial residual, by the bound ½ √c ln(2/tolerance). The condition number c is that of the shortest waves, for which
/// uᵀAu is at most d + 1 times uᵀDu on linear simplices, relative to that of a shear of the whole body; rigid motions
/// are few, and cost few iterations. On linear simplices, for steps in which a wave crosses from two cells to the body,
/// it is the count within a factor of two; other cells have not been measured. Takes the time of assembling K.
[[nodiscard]] IterationEstimate estimate_iterations(const SemidiscreteProblem& problem,
                                                    const OperatorCoefficients& coefficients, double tolerance);

/// `predicted` is the cost of a factorization. `iterations` is called only if it matters.
[[nodiscard]] ChosenMethod choose_method(const SparseCholesky::Prediction& predicted,
                                         const OperatorCoefficients& coefficients, const StepSolverOptions& options,
                                         const std::function<IterationEstimate()>& iterations);
/// Chooses likewise, with estimate_iterations.
[[nodiscard]] ChosenMethod choose_method(const SemidiscreteProblem& problem,
                                         const SparseCholesky::Prediction& predicted,
                                         const OperatorCoefficients& coefficients, const StepSolverOptions& options);

}  // namespace ricochet
