#include <algorithm>

#include "ricochet/fem/cell_rotations.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"

/// @file Validity of small strain in a run's impacts, as far as rotations are concerned.
namespace ricochet {

double RunSummary::largest_rotation() const {
  return rotation ? rotation->limit : rotation_limit;
}

bool RunSummary::cells_turn_little_in(std::size_t impact) const {
  return rotation ? rotation->holds_in_impact(impact) : digest("max_rotation").maximum <= largest_rotation();
}

bool RunSummary::small_strain_holds_in(std::size_t impact) const {
  return cells_turn_little_in(impact) && !(impact < impacts.size() && is_distorted_by_rotation(impacts[impact]));
}

bool RunSummary::cells_turn_little_in_impacts() const {
  if (impacts.empty() || impacts_left_out > 0) return digest("max_rotation").maximum <= largest_rotation();
  for (std::size_t i = 0; i < impacts.size(); ++i) {
    if (!cells_turn_little_in(i)) return false;
  }
  return true;
}

bool RunSummary::small_strain_holds_in_impacts() const {
  return cells_turn_little_in_impacts() && std::none_of(impacts.begin(), impacts.end(), is_distorted_by_rotation);
}

}  // namespace ricochet
