#pragma once

#include <array>
#include <vector>

#include "ricochet/mesh/cell_type.hpp"

/// @file Decomposition of facets into segments and triangles between their nodes.
namespace ricochet {

/// Local node numbers of the facet; the third is −1 for a segment.
using FlatPiece = std::array<int, 3>;

/// Returns the pieces of an interval, a triangle or a quadrilateral of degree 1 or 2. They have the facet's
/// orientation: segments lead from its first vertex to its second, triangles have the orientation of the vertices 0, 1,
/// 2 of the facet. Together they use all of its nodes, and the pieces of facets that share an edge match along it.
[[nodiscard]] const std::vector<FlatPiece>& flat_pieces(CellShape facet, int degree);

}  // namespace ricochet
