#pragma once

#include "ricochet/scheme/state.hpp"

/// @file What acts during a step besides the forces in the state.
namespace ricochet {

/// Forces of another instant that act during a step besides those in the state: of a scheme that has several stages
/// which do work. With the weights w of WorkRule and of these,
///   P₁ − P₀ = h Σ w F,   E₁ − E₀ = Σ w Fᵀ increment, and corrections.
struct StepPart {
  StepForces forces;
  double weight = 0.0;
  Vector increment;                   ///< displacement that they work on, as if they acted over the whole step
  ObstacleMotion obstacle_increment;  ///< likewise
};

}  // namespace ricochet
