#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file The longest stable step of central differences.
namespace ricochet {

/// An upper bound, at most 2 % too large, of the largest eigenvalue λ of K_ii x = λ M_ii x on the dofs with mass that
/// no support holds (M diagonal there), all contact nodes held. Letting contact nodes go can only lower λ: their static
/// condensation K_ii − K_ic K_cc⁻¹ K_ci is at most K_ii. About 100 products with K. 0 when there are no such dofs.
[[nodiscard]] double bound_frequency_squared(const SemidiscreteProblem& problem);

/// The step up to which central differences are stable: 2/√λ with the bound above. Damping proportional to the mass, of
/// which they take the mean over two half steps, does not change it. Infinite when nothing has both mass and freedom.
[[nodiscard]] double central_difference_limit(const SemidiscreteProblem& problem);

}  // namespace ricochet
