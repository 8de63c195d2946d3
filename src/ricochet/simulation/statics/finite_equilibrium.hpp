#pragma once

#include "ricochet/simulation/statics/static_equilibrium.hpp"

/// @file Equilibrium at finite strain.
namespace ricochet {

/// Loads and prescribed displacements grow from zero in increments whose lengths adapt to Newton's method, which starts
/// each with the tangent at its beginning; friction opposes the slip of each increment. Bodies that only contact holds
/// are treated by the proximal point method (static_equilibrium.hpp): each correction at the end is one of its
/// iterations, until the residual of all forces is rounding. Throws Error(not_converged), with the fraction of the
/// loads that was reached.
[[nodiscard]] StaticEquilibrium finite_equilibrium(const SemidiscreteProblem& problem, const Vector& guess,
                                                   const StepSolverOptions& options);

}  // namespace ricochet
