#pragma once

#include <array>
#include <vector>

#include "ricochet/mesh/cell_type.hpp"

/// @file Facets as segments and triangles between their nodes.
namespace ricochet {

/// Numbers of the facet's own nodes; the third is −1 of a segment.
using FlatPiece = std::array<int, 3>;

/// The pieces of an interval, a triangle or a quadrilateral of degree 1 or 2. They have the facet's orientation:
/// segments lead from its first vertex to its second one, triangles go round as the vertices 0, 1, 2 of the facet do.
/// Together they reach all of its nodes, and those of facets that share an edge meet along it.
[[nodiscard]] const std::vector<FlatPiece>& flat_pieces(CellShape facet, int degree);

}  // namespace ricochet
