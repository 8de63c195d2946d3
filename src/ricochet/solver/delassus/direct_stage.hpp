#pragma once

#include <memory>
#include <vector>

#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/solver/stage/stage_solver.hpp"

/// @file Stages that are solved with a factor of the whole operator.
namespace ricochet {

/// A on the dofs that a stage solves for, and the predicted cost of its factorization.
struct AnalysedOperator {
  std::vector<int> dofs;      ///< ascending
  SparseRowMatrix supported;  ///< A's rows of supported dofs: supports × all dofs
  SparseCholesky factor;      ///< of A on these dofs, analysed
};
[[nodiscard]] AnalysedOperator analyse_operator(const SemidiscreteProblem& problem,
                                                const OperatorCoefficients& coefficients);

/// Forward solve, condensed contact problem, back solve. `condensed_stage` is the stage of A_c, if the coefficients
/// name one; keeps references to it and to `shared`. Throws Error(invalid_input) if A is not positive definite.
[[nodiscard]] std::unique_ptr<StageSolver> make_direct_stage(const SemidiscreteProblem& problem,
                                                             const OperatorCoefficients& coefficients,
                                                             AnalysedOperator analysed, SharedContact& shared,
                                                             FactoredStage* condensed_stage = nullptr);

}  // namespace ricochet
