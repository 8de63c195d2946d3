#pragma once

#include "ricochet/simulation/statics/static_equilibrium.hpp"

/// @file Equilibrium at finite strain.
namespace ricochet {

/// Loads and prescribed displacements grow from zero, and overlaps decrease to zero, in parts whose sizes adapt to
/// Newton's method (equilibrium_equations.hpp): with a factor that is kept or, where that is slow, with the exact
/// tangent. Friction opposes the slip of each part. Bodies that only contact holds are treated by the proximal point
/// method (static_equilibrium.hpp): each correction at the end is one of its iterations, until the residual of all
/// forces is rounding. From an unstable equilibrium the bodies descend to a stable one, if one is found. Throws
/// Error(not_converged), with the fraction of the loads that was reached.
[[nodiscard]] StaticEquilibrium finite_equilibrium(const SemidiscreteProblem& problem, const Vector& guess,
                                                   const StepSolverOptions& options);

}  // namespace ricochet
