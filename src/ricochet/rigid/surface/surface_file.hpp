#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

/// @file Surfaces of rigid bodies from files: triangles in space, polygons in the plane.
namespace ricochet {

/// Facets as in the file, each with its own corners; segments have two, with third coordinate 0.
struct SurfaceFacets {
  std::vector<std::array<Eigen::Vector3d, 3>> corners;
  bool in_space = true;
  /// Noun for a facet in messages.
  [[nodiscard]] const char* noun() const { return in_space ? "triangle" : "segment"; }
  [[nodiscard]] int corner_count() const { return in_space ? 3 : 2; }
};

/// Reads STL, binary or ASCII; coordinates are multiplied by `scale`. The normals in the file are ignored: the order of
/// the corners determines the orientation, counterclockwise seen from outside. Throws Error(file_access), or
/// Error(invalid_input) with the file, and the line or triangle.
[[nodiscard]] SurfaceFacets read_stl(const std::string& file, double scale);
/// Reads text: x and y of a corner in each line, separated by spaces or a comma; # begins a comment, an empty line ends
/// a polygon. A polygon whose last corner equals its first is closed. The body is on the right of the lines.
[[nodiscard]] SurfaceFacets read_polygons(const std::string& file, double scale);

}  // namespace ricochet
