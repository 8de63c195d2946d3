#pragma once

#include <vector>

#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/simulation/monitor/body_surface.hpp"

/// @file Triangulation of boundary facets into the pieces of a surface.
namespace ricochet {

/// Segments or triangles between the nodes of the facets, with normals out of the facets' cells. `positions`: d ×
/// nodes.
[[nodiscard]] std::vector<BodySurface::Piece> surface_pieces(const Points& positions,
                                                             const std::vector<CellBlock>& cells,
                                                             const std::vector<CellFacet>& facets);

}  // namespace ricochet
