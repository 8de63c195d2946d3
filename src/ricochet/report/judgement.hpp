#pragma once

#include <string>

#include "ricochet/report/run_data.hpp"

/// @file What a reader wants to know of a run first: is energy made or lost, does the contact force rattle, how deep do
/// obstacles and body overlap?
namespace ricochet {

struct Judgement {
  /// What energy is compared with: that of the start, |total| or kinetic + elastic; where both are zero the largest
  /// kinetic + elastic energy of the run.
  double energy_scale = 0.0;
  /// Nothing but contact acts on the energy: no loads that vary, friction, supports, moving obstacles or damping. Then
  /// changes are those of the total energy, else those that the contact forces' normal part has made (contact_work).
  bool is_isolated = false;
  double energy_gain = 0.0;      ///< the largest rise above the start, ≥ 0
  double energy_loss = 0.0;      ///< the largest fall below the start, ≥ 0
  double energy_change = 0.0;    ///< at the end
  double energy_residual = 0.0;  ///< the largest |energy_residual|

  std::string force;  ///< the column looked at: of the first probe in contact, or a component of the resultant
  double force_largest = 0.0;
  double force_variation = 0.0;  ///< Σ |change from row to row|
  double trend_variation = 0.0;  ///< the same of its mean over a hundredth of the run around each row
  /// How many times as much as its trend the force varies: near 1 it is smooth, far above it rattles. 0: no force.
  double roughness = 0.0;

  double penetration = 0.0;           ///< the deepest
  double relative_penetration = 0.0;  ///< to the diagonal of the box around the body; 0 where the body is not known
};

[[nodiscard]] Judgement judge(const RunData& run);

}  // namespace ricochet
