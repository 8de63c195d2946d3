#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "ricochet/contact/sliding/self_contact_selection.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

namespace ricochet {

/// Latest views of the points of a pair. Views and flags are per point of the pair; flags are 0 or 1.
struct PairViews {
  using Views = std::vector<SlidingView>;

  Vector start_at;                 ///< displacement at which `at_start` was computed, d per node of the body
  Vector gaps_at;                  ///< displacement at which `gaps` were computed, likewise
  Vector couples_at;               ///< displacement at which `couples` were computed, likewise
  Views at_start;                  ///< at the start of the step, without rows
  Views gaps;                      ///< at the last evaluation of gaps, without rows; valid for points that are not far
  Views middle;                    ///< in the middle of the step, or at the instant; valid unless left out
  Views entering;                  ///< at the end of the step; valid for points that enter
  Views couples;                   ///< at the last evaluation of couples; valid for points with forces there
  std::vector<char> any_depth;     ///< points that face something at the start of the step; empty: none
  std::vector<char> out_of_reach;  ///< points beyond the motion of the step: their gaps are those of its start
  std::vector<char> left_out;      ///< points that are far or face nothing, and have no view in `middle`
  std::vector<char> forceless;     ///< points that have no view in `couples`
  std::optional<SelfContactSelection> chosen;  ///< for contact of the surface with itself
  bool has_start = false, has_gaps = false, has_couples = false;
  bool is_apart = false;  ///< whether the pair was skipped in the last update

  [[nodiscard]] bool is_out_of_reach(std::size_t point) const {
    return !out_of_reach.empty() && out_of_reach[point] != 0;
  }
  /// Whether `couples` are those at a displacement of all points that are not left out.
  [[nodiscard]] bool has_couples_at(const Vector& displacement, const std::vector<char>& without) const {
    return has_couples && couples_at == displacement &&
           std::ranges::equal(without, forceless, [](char out, char unknown) { return out >= unknown; });
  }
  /// Whether a point faces nothing at the start or in the middle of the step, but does at its end.
  [[nodiscard]] bool enters(std::size_t i) const { return left_out[i] == 0 && !(at_start[i].faces && middle[i].faces); }
};

}  // namespace ricochet
