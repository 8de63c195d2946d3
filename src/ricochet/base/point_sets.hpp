#pragma once

#include "ricochet/base/types.hpp"

/// @file Sizes of point sets that are invariant under rotation, reflection and renumbering. The sides of a bounding box
/// depend on the axes of the frame: a box serves for pictures, for searches, and for scales of rounding errors.
namespace ricochet {

/// Largest distance between two of a few points (d × count), such as the nodes of a facet: all pairs are compared.
[[nodiscard]] double largest_distance(const Points& points);

/// Diameter of the smallest ball enclosing any number of points (d × count): the diagonal of a rectangle or a box, the
/// diameter of a disc. It is at least their largest distance and exceeds it by at most a fifth (2D) or a quarter (3D).
[[nodiscard]] double enclosing_diameter(const Points& points);

}  // namespace ricochet
