#pragma once

#include <limits>
#include <vector>

/// @file How far the surfaces of two bodies have slid along each other.
namespace ricochet {

/// The largest slip of a pressed point of a contact between bodies, since the position at which facets were paired,
/// relative to its limit: half of the smaller one of the facets there.
struct PairSliding {
  int contact = 0;  ///< index of [[contact]]
  double slip = 0.0, limit = 0.0;
  double time = 0.0;
  std::vector<double> place = {};  ///< of the point, reference position
  double time_beyond =
      std::numeric_limits<double>::infinity();  ///< of the first step above it; infinite: there is none

  [[nodiscard]] bool is_beyond() const { return slip > limit; }
};

}  // namespace ricochet
