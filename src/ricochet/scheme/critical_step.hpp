#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The longest stable step of central differences.
namespace ricochet {

/// Relative excess ε of the bounds of λ, at most (largest_eigenvalue.hpp).
inline constexpr double frequency_spread = 0.02;

/// Returns an upper bound, at most 2 % too large, of the largest eigenvalue λ of K_ii x = λ M_ii x on the unsupported
/// dofs with mass (M diagonal there), all contact nodes held. Releasing contact nodes can only lower λ: their static
/// condensation K_ii − K_ic K_cc⁻¹ K_ci is at most K_ii. Costs about 100 products with K. 0 if there are no such dofs.
/// At finite strain K is the tangent at the displacement (empty: the undeformed body), assembled for this purpose.
[[nodiscard]] double bound_frequency_squared(const SemidiscreteProblem& problem, const Vector& displacement = {});

/// Returns the step up to which central differences are stable: 2/√λ with the bound above. Damping proportional to the
/// mass, which central differences average over two half steps, does not change it. Infinite if no dof has both mass
/// and freedom.
[[nodiscard]] double central_difference_limit(const SemidiscreteProblem& problem, const Vector& displacement = {});

/// Returns M^{-½} on the unsupported dofs with mass, else 0, for masses multiplied by 2^−exponent, which brings them
/// near 1: units that differ by powers of two yield the same bits. All 0 if there are no such dofs.
[[nodiscard]] Vector inverse_root_mass(const SemidiscreteProblem& problem, int& exponent);

}  // namespace ricochet
