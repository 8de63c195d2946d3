#pragma once

#include <optional>
#include <string>

#include "ricochet/report/run_data.hpp"

/// @file Assessment of a run for its readers: energy gained or lost, oscillation of the contact force, and penetration
/// of obstacles and bodies.
namespace ricochet {

struct Judgement {
  /// First times at which examined values are not finite; the other results are then meaningless.
  std::optional<double> energy_broken_at, force_broken_at, penetration_broken_at;

  /// Energy to which changes are compared: that of the start, |total| or kinetic + elastic; if both are zero, or tiny
  /// while other forces than contact do work, the largest kinetic + elastic energy of the run.
  double energy_scale = 0.0;
  /// True if nothing but contact affects the energy: no varying loads, friction, supports, moving obstacles or damping.
  /// Changes are then those of the total energy, else those caused by the method (contact_work less
  /// numerical_dissipation and the change of algorithmic_energy).
  bool is_isolated = false;
  double energy_gain = 0.0;      ///< largest rise above the initial value, ≥ 0
  double energy_loss = 0.0;      ///< largest fall below the initial value, ≥ 0
  double energy_change = 0.0;    ///< at the end
  double energy_residual = 0.0;  ///< largest |energy_residual|

  std::string force;              ///< the column examined: the largest component of the contact force on the body
  double force_largest = 0.0;     ///< largest length of the contact force on the body, over all components
  double force_largest_at = 0.0;  ///< time of the largest force
  double force_variation = 0.0;   ///< Σ |change from row to row|
  double trend_variation = 0.0;   ///< of the mean over a hundredth of the run around each row, at least 11 rows
  /// Ratio of the variations of the force and of its trend: close to 1 for a smooth force, much larger for an
  /// oscillating one. 0: there is no force, or too few rows.
  double roughness = 0.0;
  /// Ratio for the first probe that is a node on the contact boundary: nodes may oscillate against one another under a
  /// smooth resultant. Empty and 0: none.
  std::string node_force;
  double node_roughness = 0.0;

  double penetration = 0.0;  ///< the deepest, at contact points and elsewhere
  /// Relative to the diagonal of the body's bounding box, or for penetration found elsewhere to the diameter of the
  /// smallest ball around the smaller body; none if the body is not known.
  std::optional<double> relative_penetration;
  /// True if boundaries without contact and pairs of bodies were examined as well.
  /// Other items that were not examined, in words; empty if none.
  std::string penetration_not_watched;
  /// Penetration that no contact prevents: the obstacle, or the bodies; empty if none.
  std::string unwatched_penetration;
  std::string contact_beyond_rim;  ///< group of a contact that extends beyond it; empty if none

  double rotation = 0.0;  ///< largest rotation of a cell, in rad
  /// Rotation above which small strain does not hold, or less if an impact tolerates less; infinite: the laws hold for
  /// any rotation.
  double rotation_limit = 0.0;
  /// True if cells rotate too far for small strain only after the last impact, so that it does hold in the impacts.
  bool rotation_after_impacts = false;
};

[[nodiscard]] Judgement judge(const RunData& run);

}  // namespace ricochet
