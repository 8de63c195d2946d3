#pragma once

#include <memory>

#include "ricochet/scheme/scheme.hpp"

/// @file What the semi-explicit scheme asks of a problem and of a time step.
namespace ricochet {

/// Throws Error(invalid_input) unless the mass is diagonal and zero on the contact nodes, damping is diagonal and the
/// internal force linear.
void require_semi_explicit(const SemidiscreteProblem& problem);
/// Throws Error(invalid_input) for a step that is not stable; warns of one that is nearly so.
void check_critical_step(double step, double critical_step);

/// The scheme "semi-explicit" without that check: for tests of what happens above the critical step.
[[nodiscard]] std::unique_ptr<Scheme> make_semi_explicit_at_any_step(double step);

}  // namespace ricochet
