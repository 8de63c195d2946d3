#pragma once

#include <limits>
#include <vector>

/// @file Relative sliding of the surfaces of two bodies.
namespace ricochet {

/// Largest slip of a pressed point of a contact between bodies, from the position in which facets were paired, relative
/// to its limit: half of the smaller one of the facets there.
struct PairSliding {
  int contact = 0;  ///< index of [[contact]]
  double slip = 0.0, limit = 0.0;
  double time = 0.0;
  std::vector<double> position = {};  ///< reference position of the point
  double time_beyond =
      std::numeric_limits<double>::infinity();  ///< of the first step above the limit; infinite if there is none

  [[nodiscard]] bool is_beyond() const { return slip > limit; }
};

/// Doubtful force of a contact with large sliding, at points where a frozen step has left a gap or an overlap, which
/// nothing closes while they are pressed. A force at a gap should not exist; an overlap should have been pushed out, by
/// a force no larger than that which moves the nodes of the point alone.
struct UnsettledContact {
  int contact = 0;                    ///< index of [[contact]]
  double share = 0.0;                 ///< largest doubtful force, relative to it and the largest normal force
  long steps = 0;                     ///< number of steps with such a point
  double first_time = 0.0;            ///< of the first such step
  double time = 0.0;                  ///< of the largest doubtful force
  double gap = 0.0;                   ///< of largest magnitude at that time; negative: an overlap
  std::vector<double> position = {};  ///< reference position of its point
  /// Share above which a force is not to be trusted.
  static constexpr double doubtful = 0.01;
};

}  // namespace ricochet
