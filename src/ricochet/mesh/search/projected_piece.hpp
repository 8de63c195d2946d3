#pragma once

#include <Eigen/Core>
#include <array>

/// @file Pieces of surfaces projected along a direction, and their intersections.
namespace ricochet {

/// A point of the plane perpendicular to the direction; the second coordinate is 0 in two dimensions.
using PlanePoint = Eigen::Vector2d;

[[nodiscard]] inline double plane_cross(const PlanePoint& a, const PlanePoint& b) { return a[0] * b[1] - a[1] * b[0]; }

/// A projected triangle or segment, counter-clockwise, with its height along the direction as a linear function.
struct ProjectedPiece {
  std::array<PlanePoint, 3> corners;
  PlanePoint slope = PlanePoint::Zero();
  double height = 0.0;  ///< at the origin of the plane
  double area = 0.0;

  [[nodiscard]] double height_at(const PlanePoint& at) const { return height + slope.dot(at); }
  /// Returns whether a point is inside, or outside by at most `outside` times the size. `is_segment`: in two
  /// dimensions.
  [[nodiscard]] bool covers(const PlanePoint& at, bool is_segment, double outside = 0.0) const;
};

/// A convex polygon, counter-clockwise; two triangles intersect in at most six corners.
struct ProjectedPolygon {
  std::array<PlanePoint, 12> corners;
  int count = 0;

  void add(const PlanePoint& corner) { corners[std::size_t(count++)] = corner; }
  [[nodiscard]] const PlanePoint& at(int k) const { return corners[std::size_t(k % count)]; }
  [[nodiscard]] double area() const;
};

/// Returns the intersection of two triangles, or of two segments (with two corners); empty if there is none.
[[nodiscard]] ProjectedPolygon intersect(const ProjectedPiece& one, const ProjectedPiece& other, bool are_segments);

}  // namespace ricochet
