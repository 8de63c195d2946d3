#pragma once

#include "ricochet/mesh/mesh.hpp"

/// @file Meshes of smaller cells.
namespace ricochet {

/// Every cell is cut at the middles of its edges: triangles and quadrilaterals into four, tetrahedra and hexahedra into
/// eight; of the three ways to cut what is left in the middle of a tetrahedron the one with the shortest diagonal is
/// taken. Facets and groups follow. Nodes keep their numbers, and new ones come after them; elements keep the tags of
/// those that they are parts of, and new nodes have the tag 0. On a geometry of second order all nodes lie on that
/// geometry, on one of first order on its straight edges: where these stand for a curve it is not found again. `times`
/// ≥ 0. Throws Error(invalid_input) where the cells could not be counted or do not fit into memory.
void refine(Mesh& mesh, int times);

}  // namespace ricochet
