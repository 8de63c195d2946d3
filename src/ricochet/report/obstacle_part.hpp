#pragma once

#include <optional>
#include <vector>

#include "ricochet/io/xdmf_reader.hpp"
#include "ricochet/report/packed_array.hpp"

/// @file The surfaces of the obstacles over time, in the format of a page.
namespace ricochet {

struct ObstaclePart {
  int corners = 2;            ///< per cell
  PackedArray cells;          ///< cells × corners
  PackedArray obstacle;       ///< per cell, from 0
  std::vector<double> times;  ///< a single one if nothing moves
  /// points × 3: one row for the first time if obstacles only translate, else one per time.
  PackedArray positions;
  std::optional<PackedArray> offsets;  ///< times × (obstacles × 3) from the first positions, if anything translates
};

/// Packs at least one frame.
[[nodiscard]] ObstaclePart pack_obstacles(const std::vector<ObstacleFrame>& frames, PackedArrays& arrays);

}  // namespace ricochet
