#pragma once

#include <optional>
#include <vector>

#include "ricochet/io/xdmf_reader.hpp"
#include "ricochet/report/packed_array.hpp"

/// @file The surfaces of the obstacles over time, as a page has them.
namespace ricochet {

struct ObstaclePart {
  int corners = 2;            ///< of a cell
  PackedArray cells;          ///< cells × corners
  PackedArray obstacle;       ///< of each cell, from 0
  std::vector<double> times;  ///< one where nothing moves
  /// points × 3: one row at the first time where obstacles only translate, else one for each time.
  PackedArray positions;
  std::optional<PackedArray> offsets;  ///< times × (obstacles × 3) from the first positions, where anything translates
};

/// At least one frame.
[[nodiscard]] ObstaclePart pack_obstacles(const std::vector<ObstacleFrame>& frames, PackedArrays& arrays);

}  // namespace ricochet
