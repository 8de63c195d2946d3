#pragma once

#include "ricochet/rigid/obstacle_shape.hpp"

/// @file Pictures of surfaces in space with two parameters.
namespace ricochet {

/// Makes (rows + 1) × columns points point(i, k) if the last column meets the first (`closes`), else (columns + 1).
/// Seen from outside, the rotation from i to k is counterclockwise.
template <class PointAt>
[[nodiscard]] ObstacleSurface grid_surface(int rows, int columns, bool closes, const PointAt& point) {
  const int wide = closes ? columns : columns + 1;
  ObstacleSurface result{Points(3, (rows + 1) * wide), {}};
  for (int i = 0; i <= rows; ++i) {
    for (int k = 0; k < wide; ++k) result.points.col(i * wide + k) = point(i, k);
  }
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < columns; ++k) {
      const int next = closes ? (k + 1) % columns : k + 1;
      for (const int corner : {i * wide + k, (i + 1) * wide + k, (i + 1) * wide + next, i * wide + next})
        result.cells.push_back(corner);
    }
  }
  return result;
}

}  // namespace ricochet
