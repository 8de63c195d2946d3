#pragma once

#include <Eigen/Core>
#include <array>

/// @file How much of a facet is near to a point.
namespace ricochet {

/// ∫ (ρ² − |y − at|²) over the part of the triangle that is nearer to the point than ρ. `normal` is that of the
/// triangle, of length 1.
[[nodiscard]] double weight_of_triangle(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& normal,
                                        const Eigen::Vector3d& at, double radius);
/// The same of a segment.
[[nodiscard]] double weight_of_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& at,
                                       double radius);

}  // namespace ricochet
