#pragma once

#include <memory>
#include <string>

#include "ricochet/scheme/scheme.hpp"

/// @file Requirements on a problem of explicit schemes with contact nodes in equilibrium.
namespace ricochet {

/// Throws Error(invalid_input), which names the scheme, unless the mass is diagonal and zero on the contact nodes,
/// damping is diagonal and no pressure follows the surface.
void require_semi_explicit(const SemidiscreteProblem& problem, const std::string& scheme);

/// Makes the scheme "semi-explicit" without a check of its step, for tests above the critical step.
[[nodiscard]] std::unique_ptr<Scheme> make_semi_explicit_at_any_step(double step);

}  // namespace ricochet
