#pragma once

#include <functional>

#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file Direct or iterative, for the stages of one operator. What is compared are counts at fixed rates, never times
/// that were measured: the choice decides bits, and is the same on every machine that has the memory.
namespace ricochet {

/// What a solve by iterations takes.
struct IterationEstimate {
  double iterations = 0.0;  ///< of conjugate gradients on the whole body
  double bytes = 0.0;       ///< that are read and written in each
};

/// Of conjugate gradients with the diagonal blocks D of A = αM + κK as preconditioner, down to this part of what they
/// begin with, by the bound ½ √c ln(2/tolerance). The condition c is that of the shortest waves, for which uᵀAu is at
/// most d + 1 times uᵀDu on linear simplices, beside that of a shear of the whole body; rigid motions are few, and cost
/// few iterations. On those, in steps in which a wave crosses from two cells to the body, it is the count within a
/// factor of two; on other cells nobody has measured it. Takes the time of assembling K.
[[nodiscard]] IterationEstimate estimate_iterations(const SemidiscreteProblem& problem,
                                                    const OperatorCoefficients& coefficients, double tolerance);

/// `predicted`: what a factorization would take. `iterations` is asked only where it matters.
[[nodiscard]] ChosenMethod choose_method(const SparseCholesky::Prediction& predicted,
                                         const OperatorCoefficients& coefficients, const StepSolverOptions& options,
                                         const std::function<IterationEstimate()>& iterations);
/// The same with estimate_iterations.
[[nodiscard]] ChosenMethod choose_method(const SemidiscreteProblem& problem,
                                         const SparseCholesky::Prediction& predicted,
                                         const OperatorCoefficients& coefficients, const StepSolverOptions& options);

}  // namespace ricochet
