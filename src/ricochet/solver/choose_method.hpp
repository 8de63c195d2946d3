#pragma once

#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file Direct or iterative, for the stages of one operator.
namespace ricochet {

/// With what a factorization would take.
[[nodiscard]] ChosenMethod choose_method(const SparseCholesky::Prediction& predicted,
                                         const OperatorCoefficients& coefficients, const StepSolverOptions& options);

}  // namespace ricochet
