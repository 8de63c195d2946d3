#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Facets of a set of cells, whether or not they belong to a group: those on its boundary, and how interior ones
/// join their cells.
namespace ricochet {

/// A facet, identified by one of its cells.
struct CellFacet {
  std::size_t block = 0;
  Index cell = 0;
  std::size_t local = 0;
};

/// Returns the facets that belong to one cell only, in the order of blocks, cells and their facets. `cells` are those
/// of a mesh or of a space.
[[nodiscard]] std::vector<CellFacet> boundary_facets(const std::vector<CellBlock>& cells);

/// A facet that two cells share, as a facet of each.
struct SharedFacet {
  CellFacet first;
  CellFacet second;
};

/// Returns the facets whose two cells lie on the same side, so that they overlap: the mesh is folded there. The order
/// in which the cells number the facet's vertices shows it, provided that the Jacobian of all cells is positive.
[[nodiscard]] std::vector<SharedFacet> folded_facets(const std::vector<CellBlock>& cells);

/// Returns the facet's nodes in the order in which the facet itself numbers them, its vertices first.
[[nodiscard]] std::vector<Index> nodes_of_facet(const std::vector<CellBlock>& cells, const CellFacet& facet);

}  // namespace ricochet
