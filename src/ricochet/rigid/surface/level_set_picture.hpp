#pragma once

#include <functional>

#include "ricochet/rigid/obstacle_shape.hpp"

/// @file Pictures of surfaces that are where a function is zero.
namespace ricochet {

/// The part of it in a square or a cube of half this width, out of lines or triangles; the function is positive
/// outside.
[[nodiscard]] ObstacleSurface picture_of_level_set(const std::function<double(const SpaceVector&)>& function,
                                                   const SpaceVector& middle, double half_width);

}  // namespace ricochet
