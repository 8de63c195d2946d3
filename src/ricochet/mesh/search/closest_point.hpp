#pragma once

#include <Eigen/Core>
#include <array>

/// @file Closest point of a segment or a triangle.
namespace ricochet {

/// The closest point, and the corners that span it: one for a corner, two for an edge (or a segment), three for the
/// interior of a triangle; the remaining entries are −1.
struct ClosestPoint {
  Eigen::Vector3d position;
  std::array<int, 3> corners{-1, -1, -1};
};

[[nodiscard]] ClosestPoint closest_on_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                                              const Eigen::Vector3d& b);
/// Follows C. Ericson, Real-Time Collision Detection, section 5.1.5.
[[nodiscard]] ClosestPoint closest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                                               const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace ricochet
