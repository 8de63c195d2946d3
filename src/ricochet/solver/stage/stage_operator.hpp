#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"

/// @file The matrix of a stage and the dofs it is solved for.
namespace ricochet {

/// A = αM + κK(U) + ηC on all dofs.
[[nodiscard]] SparseMatrix combine_operator(const SemidiscreteProblem& problem,
                                            const OperatorCoefficients& coefficients, const Vector& displacement = {});
/// K(U) of it, with what relaxes over the stage, and what loads that follow the surface add to it; U empty: the
/// undeformed body, on which they do not act.
[[nodiscard]] SparseMatrix stage_stiffness(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                           const Vector& displacement);

/// The dofs that a stage solves for, ascending: no supported ones, and of the others those that it names.
[[nodiscard]] std::vector<int> solved_dofs(const SemidiscreteProblem& problem, StageDofs dofs);

/// Says at which node an operator turned out not to be positive definite. Throws Error(invalid_input).
[[noreturn]] void refuse_operator(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                  Index dof);

/// Of a matrix on all dofs its rows of supported ones: supports × dofs.
[[nodiscard]] SparseRowMatrix supported_rows(const SemidiscreteProblem& problem, const SparseMatrix& matrix);

/// The reactions of supports that a solution asks for, A_s δ − b − Hᵀρ̄ with the rows of supported_rows(). Ranks have a
/// part each. `contact_force`: work space.
void find_support_reaction(const SemidiscreteProblem& problem, const Stage& stage, const SparseRowMatrix& supported,
                           Vector& contact_force, StageSolution& solution);

/// Writes what a stage prescribes to its supported dofs. `increment`: per dof.
void prescribe(const SemidiscreteProblem& problem, const Stage& stage, Vector& increment);

/// Numbers of the given dofs: per dof of the problem its place in the list, or −1.
[[nodiscard]] std::vector<int> number_dofs(const SemidiscreteProblem& problem, const std::vector<int>& dofs);

}  // namespace ricochet
