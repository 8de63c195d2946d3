#pragma once

#include <memory>
#include <string>

#include "ricochet/scheme/scheme.hpp"

/// @file What explicit schemes with contact nodes in equilibrium ask of a problem.
namespace ricochet {

/// Throws Error(invalid_input) unless the mass is diagonal and zero on the contact nodes and damping is diagonal. The
/// message names the scheme.
void require_semi_explicit(const SemidiscreteProblem& problem, const std::string& scheme);

/// The scheme "semi-explicit" without that check: for tests of what happens above the critical step.
[[nodiscard]] std::unique_ptr<Scheme> make_semi_explicit_at_any_step(double step);

}  // namespace ricochet
