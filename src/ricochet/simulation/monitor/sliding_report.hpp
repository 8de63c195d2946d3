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

/// Force at stake in a contact between bodies that slide far, at points that a held step has left at a gap or an
/// overlap, which nothing closes while they are pressed. A force at a gap should not be there; an overlap should have
/// been pushed out, by a force that is no larger than what moves the nodes of the point alone.
struct UnsettledContact {
  int contact = 0;                 ///< index of [[contact]]
  double share = 0.0;              ///< largest force at stake, of it and the largest normal force
  long steps = 0;                  ///< with such a point
  double first_time = 0.0;         ///< of these
  double time = 0.0;               ///< of the largest force
  double gap = 0.0;                ///< of largest size then; negative: an overlap
  std::vector<double> place = {};  ///< of its point, reference position
  /// Above this share a force is not to be trusted.
  static constexpr double doubtful = 0.01;
};

}  // namespace ricochet
