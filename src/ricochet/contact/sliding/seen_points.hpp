#pragma once

#include <optional>
#include <vector>

#include "ricochet/contact/sliding/chosen_points.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

namespace ricochet {

/// Facets that the points of a pair were found to see lately.
struct SeenPoints {
  using Views = std::vector<SlidingView>;

  Vector start_at, gaps_at;
  Views at_start, gaps, middle, entering, other;
  std::vector<char> any_depth;  ///< points that face something where the step begins
  std::vector<char> far;        ///< points that do not move so far in the step: their gaps are those of its start
  std::vector<char> left_out;   ///< of a look at rows
  std::optional<ChosenPoints> chosen;  ///< where the pair touches itself
  bool has_start = false, has_gaps = false;
  bool is_apart = false;  ///< at the last update, nothing was looked at

  [[nodiscard]] bool is_far(std::size_t point) const { return !far.empty() && far[point] != 0; }
  /// Points that face nothing where the step begins, or in its middle, but where it ends.
  [[nodiscard]] bool enters(std::size_t i) const { return left_out[i] == 0 && !(at_start[i].faces && middle[i].faces); }
};

}  // namespace ricochet
