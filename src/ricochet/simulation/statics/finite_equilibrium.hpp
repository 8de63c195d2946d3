#pragma once

#include "ricochet/simulation/statics/static_equilibrium.hpp"

/// @file Equilibrium at finite strain.
namespace ricochet {

/// Loads and prescribed displacements grow from nothing in increments whose lengths follow Newton's method, which
/// starts each with the tangent there; friction is that of the slips on this way. Bodies that only contact holds are
/// treated by the proximal point method (static_equilibrium.hpp), of which each correction at the end is a round, until
/// what is left of all forces is rounding. Throws Error(not_converged), with the part of the loads that was reached.
[[nodiscard]] StaticEquilibrium finite_equilibrium(const SemidiscreteProblem& problem, const Vector& guess,
                                                   const StepSolverOptions& options);

}  // namespace ricochet
