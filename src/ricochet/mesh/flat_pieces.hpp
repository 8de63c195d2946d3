#pragma once

#include <array>
#include <vector>

#include "ricochet/mesh/shapes/cell_shape.hpp"

/// @file Decomposition of facets and cells into segments, triangles and tetrahedra between their nodes.
namespace ricochet {

/// Local node numbers of a segment, triangle or tetrahedron; −1 beyond its vertices.
using FlatPiece = std::array<int, 4>;

/// Returns the pieces of a facet or cell of degree 1 or 2. They have its orientation: segments lead from its first
/// vertex to its second, triangles have the orientation of the vertices 0, 1, 2, tetrahedra a positive volume. Together
/// they use all of its nodes, and the pieces of facets that share an edge match along it.
[[nodiscard]] const std::vector<FlatPiece>& flat_pieces(CellShape shape, int degree);

}  // namespace ricochet
