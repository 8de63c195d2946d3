#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file Equilibrium with contact and friction.
namespace ricochet {

struct StaticEquilibrium {
  Vector displacement;
  Vector normal_reaction;  ///< r_N, per contact point
};

/// Solves K U = L(0) + Gᵀ r with contact and supports, from an initial guess. Bodies that only contact holds are
/// treated by the proximal point method, (εM + K)(U_{k+1} − U_k) = L − K U_k + Gᵀr_N − B_Tᵀr_T, which converges to the
/// equilibrium itself for any ε > 0 if there is one. With friction the equilibrium depends on the history of the loads:
/// it is the one in which friction opposes the whole displacement from the undeformed body, or, where `velocity` slides
/// along the obstacle, that sliding; if no equilibrium with this friction exists, friction is excluded at the points
/// that slide (which is logged). Throws Error(invalid_input), with the unbalanced force, if there is none.
[[nodiscard]] StaticEquilibrium static_equilibrium(const SemidiscreteProblem& problem, const Vector& guess,
                                                   const Vector& velocity, const StepSolverOptions& options = {});

}  // namespace ricochet
