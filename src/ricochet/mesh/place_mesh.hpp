#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Putting a body where it is wanted, which need not be where its file has it.
namespace ricochet {

struct Turn {
  double angle = 0.0;         ///< degrees, right-handed about the axis; in two dimensions counter-clockwise
  std::vector<double> axis;   ///< in three dimensions only, of any length but zero; needed where the angle is not zero
  std::vector<double> about;  ///< a point of the axis; empty: the origin
};

/// Turns, each of the body as those before it have left it, then a translation.
struct Placement {
  std::vector<Turn> turns;
  std::vector<double> move;  ///< empty: none
};

/// Each turn is x ↦ c + R (x − c), with the rotation R (Rodrigues' formula) and c = about; then x ↦ x + move. Multiples
/// of 90° about an axis of coordinates are exact. Vectors have as many entries as the mesh has dimensions. Throws
/// Error(invalid_input) when coordinates overflow.
void place_mesh(Mesh& mesh, const Placement& placement);

}  // namespace ricochet
