#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/stage.hpp"

/// @file Matrix of a stage, and the dofs it is solved for.
namespace ricochet {

/// A = αM + κK(U) + ηC on all dofs.
[[nodiscard]] SparseMatrix combine_operator(const SemidiscreteProblem& problem,
                                            const OperatorCoefficients& coefficients, const Vector& displacement = {});
/// K(U) of the operator, including viscoelastic branches over the stage and follower loads; U empty: the undeformed
/// body, on which these loads do not act.
[[nodiscard]] SparseMatrix stage_stiffness(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                           const Vector& displacement);

/// Dofs that a stage solves for, ascending: of the unsupported ones those that it names.
[[nodiscard]] std::vector<int> solved_dofs(const SemidiscreteProblem& problem, StageDofs dofs);

/// Reports the node at which an operator turned out not to be positive definite. Throws Error(invalid_input).
[[noreturn]] void refuse_operator(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                  Index dof);

/// Extracts from a matrix on all dofs its rows of supported ones: supports × dofs.
[[nodiscard]] SparseRowMatrix supported_rows(const SemidiscreteProblem& problem, const SparseMatrix& matrix);

/// Computes the support reactions of a solution, A_s δ − b − Hᵀρ̄ with the rows of supported_rows(). Ranks have a part
/// each. `contact_force` is work space.
void find_support_reaction(const SemidiscreteProblem& problem, const LinearStage& stage,
                           const SparseRowMatrix& supported, Vector& contact_force, StageSolution& solution);

/// Writes the prescribed values of a stage to its supported dofs. `increment` is per dof.
void prescribe(const SemidiscreteProblem& problem, const LinearStage& stage, Vector& increment);

/// Numbers of the given dofs: per dof of the problem its index in the list, or −1.
[[nodiscard]] std::vector<int> number_dofs(const SemidiscreteProblem& problem, const std::vector<int>& dofs);

}  // namespace ricochet
