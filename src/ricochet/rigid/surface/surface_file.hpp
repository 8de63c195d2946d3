#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

/// @file Surfaces of rigid bodies from files: triangles in space, polygons in the plane.
namespace ricochet {

/// Facets as they are in the file, each with corners of its own; segments have two, and 0 for the third coordinate.
struct SurfaceFacets {
  std::vector<std::array<Eigen::Vector3d, 3>> corners;
  bool in_space = true;
  /// Of the facets for messages: "triangle" or "segment", and where each begins in the file.
  [[nodiscard]] const char* noun() const { return in_space ? "triangle" : "segment"; }
  [[nodiscard]] int corner_count() const { return in_space ? 3 : 2; }
};

/// STL, binary or ASCII; coordinates times `scale`. The normals in the file are not read: the order of the corners
/// tells, counterclockwise where one looks at a triangle from outside. Throws Error(file_access), or
/// Error(invalid_input) with the file, and the line or triangle.
[[nodiscard]] SurfaceFacets read_stl(const std::string& file, double scale);
/// Text: x and y of a corner in each line, separated by spaces or a comma; # begins a comment, an empty line ends a
/// polygon. One whose last corner is its first is closed. The body is to the right of the lines.
[[nodiscard]] SurfaceFacets read_polygons(const std::string& file, double scale);

}  // namespace ricochet
