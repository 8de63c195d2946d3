#pragma once

#include "ricochet/base/types.hpp"

/// @file Sizes of sets of points that no rotation, reflection or renumbering changes. The sides of the box around
/// points depend on the axes of the frame: a box is for pictures, for searches, and for scales of rounding errors.
namespace ricochet {

/// Largest distance between two of a few points (d × count), such as the nodes of a facet: each is compared with each.
[[nodiscard]] double largest_distance(const Points& points);

/// Diameter of the smallest ball around points (d × count), whatever their number: the diagonal of a rectangle or a
/// box, the diameter of a disc. It is at least their largest distance, and exceeds it by a fifth (2D) or a quarter (3D)
/// at most.
[[nodiscard]] double enclosing_diameter(const Points& points);

}  // namespace ricochet
