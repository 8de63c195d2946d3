#pragma once

#include <span>

#include "ricochet/scheme/state.hpp"

/// @file Report of a scheme on its last step, for the accounts of energy and momentum.
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

/// Closed-form terms of the energy balance besides the works of forces on increments.
struct StepCorrections {
  double contact_work = 0.0;           ///< if the contact forces act along a path that is not straight
  double friction_work = 0.0;          ///< likewise
  double support_work = 0.0;           ///< of reactions that do not belong to the step's forces
  double load_work = 0.0;              ///< of loads that vary on nodes without inertia
  double numerical_dissipation = 0.0;  ///< energy dissipated by the scheme itself, positive if lost
  /// ΔW less the work of the scheme's internal forces over a step, if these are nonlinear in the displacement: spurious
  /// energy of either sign.
  double integration_error = 0.0;
  double viscous_dissipation = 0.0;  ///< of viscoelastic branches, never negative
};

/// Valid until the scheme's next step.
struct LastStep {
  StepCorrections corrections = {};
  std::span<const StepPart> other_parts = {};  ///< forces that are not in the state
  /// Displacement at which the end forces act at finite strain; null: half way through the step.
  const Vector* displacement_of_forces = nullptr;
  /// True if contact forces between bodies have couples there (ContactGeometry::add_couples).
  bool has_couples_between_bodies = false;
};

}  // namespace ricochet
