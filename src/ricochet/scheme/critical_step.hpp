#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The longest stable step of central differences.
namespace ricochet {

/// ε of largest_eigenvalue.hpp: bounds of λ are at most this part too large.
inline constexpr double frequency_spread = 0.02;

/// An upper bound, at most 2 % too large, of the largest eigenvalue λ of K_ii x = λ M_ii x on the dofs with mass that
/// no support holds (M diagonal there), all contact nodes held. Letting contact nodes go can only lower λ: their static
/// condensation K_ii − K_ic K_cc⁻¹ K_ci is at most K_ii. About 100 products with K. 0 when there are no such dofs.
/// At finite strain K is the tangent at the displacement (empty: of the undeformed body), assembled for that.
[[nodiscard]] double bound_frequency_squared(const SemidiscreteProblem& problem, const Vector& displacement = {});

/// The step up to which central differences are stable: 2/√λ with the bound above. Damping proportional to the mass, of
/// which they take the mean over two half steps, does not change it. Infinite when nothing has both mass and freedom.
[[nodiscard]] double central_difference_limit(const SemidiscreteProblem& problem, const Vector& displacement = {});

/// M^{-½} on the dofs with mass that no support holds, else 0, of masses that are multiplied by 2^−exponent, which
/// brings them near 1: units that differ by powers of two give the same bits. All 0 when there are no such dofs.
[[nodiscard]] Vector inverse_root_mass(const SemidiscreteProblem& problem, int& exponent);

}  // namespace ricochet
