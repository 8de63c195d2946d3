#pragma once

#include <optional>
#include <vector>

#include "ricochet/contact/sliding/chosen_points.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

namespace ricochet {

/// What the points of a pair were found to see lately. Views and flags are per point of the pair; flags are 0 or 1.
struct SeenPoints {
  using Views = std::vector<SlidingView>;

  Vector start_at;  ///< displacement at which `at_start` was found, d per node of the body
  Vector gaps_at;   ///< displacement at which `gaps` were found, likewise
  Views at_start;   ///< where the step begins, without rows
  Views gaps;       ///< where the gaps were last asked for, without rows; valid for points that are not far
  Views middle;     ///< in the middle of the step, or at the instant; valid for points that are not left out
  Views entering;   ///< at the end of the step; valid for points that enter
  Views other;      ///< where couples were last asked for; valid for points on which forces act
  std::vector<char> any_depth;  ///< points that face something where the step begins; empty: none
  std::vector<char> far;        ///< points that do not move so far in the step: their gaps are those of its start
  std::vector<char> left_out;   ///< points that are far or face nothing, and have no view in `middle`
  std::optional<ChosenPoints> chosen;  ///< where the pair touches itself
  bool has_start = false, has_gaps = false;
  bool is_apart = false;  ///< at the last update, nothing was looked at

  [[nodiscard]] bool is_far(std::size_t point) const { return !far.empty() && far[point] != 0; }
  /// Points that face nothing where the step begins, or in its middle, but where it ends.
  [[nodiscard]] bool enters(std::size_t i) const { return left_out[i] == 0 && !(at_start[i].faces && middle[i].faces); }
};

}  // namespace ricochet
