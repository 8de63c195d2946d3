#pragma once

#include <memory>
#include <string>
#include <vector>

#include "support/box_mesh.hpp"

/// @file Two bodies in one mesh, made in memory.
namespace ricochet::test_support {

/// Writes the mesh as text of Gmsh's format 2.2 to a file of this name in the tests' temporary directory. Returns its
/// path.
[[nodiscard]] std::string write_mesh(const std::string& name, const Mesh& mesh);

/// A box on another one: the lower one touches with the side of its largest last coordinate, the upper one with the
/// side of the smallest. Groups are called "lower.y1", "upper.y0", …
struct StackedBoxes {
  CellShape lower_shape = CellShape::triangle, upper_shape = CellShape::triangle;
  std::vector<int> lower_counts = {}, upper_counts = {};
  double distortion = 0.15;
  int geometry_degree = 1;
  PointMap lower_map = {}, upper_map = {};  ///< from [0, 1]ᵈ; empty: [0, 1]ᵈ, and the same above it
  PointMap both = {};                       ///< rigid motion of both, applied after these; empty: none
};
[[nodiscard]] Mesh make_stack(const StackedBoxes& stack);

/// A rotation about a skew axis, and a translation.
[[nodiscard]] PointMap skew_motion(int dimension);

}  // namespace ricochet::test_support
