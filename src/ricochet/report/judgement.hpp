#pragma once

#include <optional>
#include <string>

#include "ricochet/report/run_data.hpp"

/// @file What a reader wants to know of a run first: is energy made or lost, does the contact force rattle, how deep do
/// obstacles and body overlap?
namespace ricochet {

struct Judgement {
  /// The time from which on a number that is looked at is not finite: then the others say nothing.
  std::optional<double> energy_broken_at, force_broken_at, penetration_broken_at;

  /// What energy is compared with: that of the start, |total| or kinetic + elastic; where both are zero, and where
  /// others than contact do work and it is tiny, the largest kinetic + elastic energy of the run.
  double energy_scale = 0.0;
  /// Nothing but contact acts on the energy: no loads that vary, friction, supports, moving obstacles or damping. Then
  /// changes are those of the total energy, else those that the method has made (contact_work less
  /// numerical_dissipation and the change of algorithmic_energy).
  bool is_isolated = false;
  double energy_gain = 0.0;      ///< the largest rise above the start, ≥ 0
  double energy_loss = 0.0;      ///< the largest fall below the start, ≥ 0
  double energy_change = 0.0;    ///< at the end
  double energy_residual = 0.0;  ///< the largest |energy_residual|

  std::string force;              ///< the column looked at: the largest component of the contact force on the body
  double force_largest = 0.0;     ///< the length of the contact force on the body, all components together
  double force_largest_at = 0.0;  ///< its time
  double force_variation = 0.0;   ///< Σ |change from row to row|
  double trend_variation = 0.0;  ///< the same of its mean over a hundredth of the run around each row, 11 rows at least
  /// How many times as much as its trend the force varies: near 1 it is smooth, far above it rattles. 0: there is no
  /// force, or too few rows to tell.
  double roughness = 0.0;
  /// The same of the first probe that is a node on the contact boundary: nodes may rattle against one another under a
  /// smooth resultant. Empty and 0: there is none.
  std::string node_force;
  double node_roughness = 0.0;

  double penetration = 0.0;  ///< the deepest, at contact points and wherever else was looked
  /// Relative to the diameter of the smallest ball around the body; nothing if the body is not known.
  std::optional<double> relative_penetration;
  /// Whether the boundary that no contact looks after, and bodies against each other, were looked at, too.
  bool penetration_checked = false;
  /// Further things that were not looked at, in words; empty if there is none.
  std::string penetration_not_watched;
  /// Where no contact prevents it: in which obstacle, or of which bodies; empty: there was none.
  std::string unwatched_penetration;
  std::string contact_beyond_rim;  ///< the group of a contact that goes on beyond it; empty: none was seen

  double rotation = 0.0;  ///< the largest of a cell, in rad
  /// Above it small strain does not hold, or less where an impact bears less; infinite: the laws hold for any rotation.
  double rotation_limit = 0.0;
  /// Whether cells turn too far for small strain only after the last impact, so that it does hold in the impacts.
  bool rotation_after_impacts = false;
};

[[nodiscard]] Judgement judge(const RunData& run);

}  // namespace ricochet
