#pragma once

#include "ricochet/scheme/state.hpp"

/// @file Forces that act during a step besides those in the state.
namespace ricochet {

/// Forces of another instant that act during a step besides those in the state, for schemes with several stages whose
/// forces do work. With the weights w of WorkRule and of these parts,
///   P₁ − P₀ = h Σ w F,   E₁ − E₀ = Σ w Fᵀ increment, and corrections.
struct StepPart {
  StepForces forces;
  double weight = 0.0;
  Vector increment;                   ///< displacement on which they do work, as if they acted over the whole step
  ObstacleMotion obstacle_increment;  ///< likewise
};

}  // namespace ricochet
