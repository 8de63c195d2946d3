#pragma once

#include <Eigen/Core>
#include <array>

/// @file The point of a segment or a triangle that is closest to another one.
namespace ricochet {

/// The closest point, and the corners between which it lies: one of a corner, two of an edge (or of a segment), three
/// of the inside of a triangle. −1 for the rest.
struct ClosestPoint {
  Eigen::Vector3d position;
  std::array<int, 3> corners{-1, -1, -1};
};

[[nodiscard]] ClosestPoint closest_on_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                                              const Eigen::Vector3d& b);
/// After C. Ericson, Real-Time Collision Detection, section 5.1.5.
[[nodiscard]] ClosestPoint closest_on_triangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                                               const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace ricochet
