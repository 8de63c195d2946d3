#pragma once

#include "ricochet/base/types.hpp"

/// @file A penalty on negative gaps whose forces are a discrete gradient of its energy.
namespace ricochet {

/// Σ ½ k_i min(g_i, 0)².
[[nodiscard]] double penalty_energy(const Vector& stiffness, const Vector& gap);

/// Per point: k, the gap at the start of a step, and that at its end if no force acted.
struct PenaltyPoints {
  Vector stiffness, before, free;
};
/// The forces r of a step, r_i = −(ψ_i(g₁)−ψ_i(g₀))/(g₁−g₀) ≥ 0 with ψ_i(g) = ½ k_i min(g, 0)² and g₁ = free + W r, W
/// positive semi-definite. r decreases with g₁, so there is one solution: Newton's method. Throws Error(not_converged).
[[nodiscard]] Vector penalty_forces(const Matrix& w, const PenaltyPoints& points);

}  // namespace ricochet
