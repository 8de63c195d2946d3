#pragma once

#include <string>

#include "ricochet/simulation/impact/impact.hpp"

/// @file Conditions under which the ratio of an impact's normal velocities characterizes the impact.
namespace ricochet {

/// Returns why an impact has no restitution: it has not ended; the body began inside; it did not approach; or it
/// approached so slowly, compared with its sliding, its spin and vibrations, or the effect of other forces meanwhile,
/// that the ratio would characterize these. For two bodies the relative motion counts. Empty if there is a restitution.
[[nodiscard]] std::string why_no_restitution(const Impact& impact);

/// Doubt about a restitution that no single rebound has: of a body that leaves while it still moves inward, or with
/// more than the velocity of its approach, which the method did not create. Empty if there is none.
[[nodiscard]] std::string restitution_doubt(const Impact& impact);

/// Energy that the time discretization has created during an impact, and 1 − e² of its restitution e: both as fractions
/// of ½ m v², v the normal velocity before and m the approach_mass().
struct RestitutionError {
  double by_method = 0.0;  ///< negative if energy is lost
  double by_impact = 0.0;
  /// True if the method's part obscures the loss of the impact itself.
  bool is_large = false;
};
/// Returns zeros if there is no restitution.
[[nodiscard]] RestitutionError restitution_error(const Impact& impact);

}  // namespace ricochet
