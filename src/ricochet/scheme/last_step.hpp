#pragma once

#include <span>

#include "ricochet/scheme/state.hpp"

/// @file Report of a scheme on its last step, for the accounts of energy and momentum.
namespace ricochet {

/// Forces of a stage that act during a step besides those in the state, for schemes with several stages whose forces do
/// work. With the weights w of WorkRule and of these stages,
///   P₁ − P₀ = h Σ w F,   E₁ − E₀ = Σ w Fᵀ increment, and corrections.
struct OtherStageForces {
  StepForces forces;
  double weight = 0.0;                ///< w, without unit
  Vector increment;                   ///< displacement on which they do work, as if they acted over the whole step
  ObstacleMotion obstacle_increment;  ///< motion of the obstacles on which the reactions do work in that sense
};

/// Terms of the energy balance besides the works of forces on increments. Works are those on the body.
struct StepCorrections {
  double contact_work = 0.0;           ///< of normal reactions along a path that is not straight
  double friction_work = 0.0;          ///< of tangential reactions along such a path
  double support_work = 0.0;           ///< of reactions that do not belong to the step's forces
  double load_work = 0.0;              ///< of loads that vary on nodes without inertia
  double numerical_dissipation = 0.0;  ///< energy dissipated by the scheme itself, positive if lost
  /// Change of the elastic energy over a step less the work of the scheme's internal forces, if these are nonlinear in
  /// the displacement: spurious energy of either sign.
  double integration_error = 0.0;
  double viscous_dissipation = 0.0;  ///< of viscoelastic branches, never negative
  /// Kinetic energy that a correction of the velocities has added to close the balance of the step: no term of it.
  double velocity_correction = 0.0;
  double energy_at_end = 0.0;  ///< kinetic and elastic energy after such a correction; 0 if the scheme makes none
};

/// Valid until the scheme's next step, and so is what it refers to.
struct LastStep {
  StepCorrections corrections = {};
  std::span<const OtherStageForces> other_stages = {};  ///< forces that are not in the state
  /// Displacement at which the end forces act at finite strain; null: the mean of those at both ends of the step.
  const Vector* displacement_of_forces = nullptr;
  /// True if contact forces between bodies have couples there (ContactGeometry::add_couples).
  bool has_couples_between_bodies = false;
};

}  // namespace ricochet
