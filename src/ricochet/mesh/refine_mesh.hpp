#pragma once

#include "ricochet/mesh/mesh.hpp"

/// @file Uniform refinement of meshes.
namespace ricochet {

/// Cuts every cell at the midpoints of its edges: triangles and quadrilaterals into four, tetrahedra and hexahedra into
/// eight. Of the three ways to cut the inner octahedron of a tetrahedron, the one with the shortest diagonal is used.
/// Facets and groups follow. Nodes keep their numbers, and new ones are appended; elements keep the tags of their
/// parents, and new nodes have the tag 0. On a second-order geometry all nodes lie on that geometry, on a first-order
/// one on its straight edges: a curve that these approximate is not recovered. `times` ≥ 0. Throws Error(invalid_input)
/// if the cells could not be counted or do not fit into memory.
void refine(Mesh& mesh, int times);

}  // namespace ricochet
