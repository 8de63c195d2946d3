#pragma once

#include <string>

#include "ricochet/simulation/impact/impact.hpp"

/// @file When the ratio of an impact's normal velocities says something of the impact.
namespace ricochet {

/// Why an impact has no restitution: it has not ended; the body began inside; it did not come nearer; or it did, but so
/// slowly beside its sliding, its spin and vibrations, or what other forces did meanwhile, that the ratio would tell of
/// these. Of two bodies it is about the motion of one against the other. Empty: there is one.
[[nodiscard]] std::string why_no_restitution(const Impact& impact);

/// What the discretization of time did to the energy during an impact, and 1 − e² of its restitution e: both as parts
/// of ½ m v², v the normal velocity before and m the approach_mass().
struct RestitutionError {
  double by_method = 0.0;  ///< negative: energy is missing
  double by_impact = 0.0;
  /// The method's part cannot be told from what the impact itself has lost.
  bool is_large = false;
};
/// All zero where there is no restitution, or where the method's part is not known.
[[nodiscard]] RestitutionError restitution_error(const Impact& impact);

}  // namespace ricochet
