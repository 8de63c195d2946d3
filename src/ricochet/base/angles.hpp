#pragma once

#include <Eigen/Geometry>
#include <cmath>

/// @file Angles between vectors.
namespace ricochet {

/// Angle between two vectors of any length, in [0, π]: accurate for small angles, too.
[[nodiscard]] inline double angle_between(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  return std::atan2(one.cross(other).norm(), one.dot(other));
}

}  // namespace ricochet
