#pragma once

#include "ricochet/base/types.hpp"

/// @file Penalty on negative gaps whose forces are a discrete gradient of its energy.
namespace ricochet {

/// Penalty energy Σ ½ k_i min(g_i, 0)².
[[nodiscard]] double penalty_energy(const Vector& stiffness, const Vector& gap);

/// Stiffness k, gap at the start of a step, and gap at its end without forces, per point.
struct PenaltyPoints {
  Vector stiffness, before, free;
};
/// Returns the forces r of a step, r_i = −(ψ_i(g₁)−ψ_i(g₀))/(g₁−g₀) ≥ 0 with ψ_i(g) = ½ k_i min(g, 0)² and
/// g₁ = free + W r, W positive semi-definite. r decreases with g₁, so the solution is unique: Newton's method. Throws
/// Error(not_converged).
[[nodiscard]] Vector penalty_forces(const Matrix& w, const PenaltyPoints& points);

}  // namespace ricochet
