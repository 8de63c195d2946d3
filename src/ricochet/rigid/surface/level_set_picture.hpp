#pragma once

#include <functional>

#include "ricochet/rigid/obstacle_shape.hpp"

/// @file Pictures of zero level sets of functions.
namespace ricochet {

/// Approximates the zero level set within a square or a cube of this half width by lines or triangles; the function is
/// positive outside.
[[nodiscard]] ObstacleSurface picture_of_level_set(const std::function<double(const SpaceVector&)>& function,
                                                   const SpaceVector& middle, double half_width);

}  // namespace ricochet
