#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Positioning a body independently of its position in the file.
namespace ricochet {

struct MeshRotation {
  double angle = 0.0;         ///< degrees, right-handed about the axis; in two dimensions counter-clockwise
  std::vector<double> axis;   ///< in three dimensions only, not zero, of any length; required if the angle is not zero
  std::vector<double> about;  ///< a point of the axis; empty: the origin
};

/// Rotations, applied one after the other, followed by a translation.
struct Placement {
  std::vector<MeshRotation> rotations;
  std::vector<double> move;  ///< empty: none
};

/// Applies each rotation, x ↦ c + R (x − c) with R from Rodrigues' formula and c = about, then x ↦ x + move. Rotations
/// by multiples of 90° about a coordinate axis are exact. Vectors have as many entries as the mesh has dimensions.
/// Throws Error(invalid_input) if coordinates overflow.
void place_mesh(Mesh& mesh, const Placement& placement);

}  // namespace ricochet
