#pragma once

#include "ricochet/scheme/state.hpp"
#include "ricochet/step/stage.hpp"

/// @file Functions shared by the searches for a starting state. Not part of the public interface.
namespace ricochet {

/// L(0) − K U − C V; an empty V is zero.
[[nodiscard]] Vector residual_force(const SemidiscreteProblem& problem, const Vector& displacement,
                                    const Vector& velocity);

/// Stage in which every contact point is eligible by its gap at the given displacement, at which the internal forces of
/// the right-hand side are evaluated as well.
[[nodiscard]] Stage contact_stage(const SemidiscreteProblem& problem, const Vector& displacement,
                                  Vector right_hand_side);

/// Largest absolute value over all ranks; 0 without entries.
[[nodiscard]] double largest(const SemidiscreteProblem& problem, const Vector& values);

}  // namespace ricochet
