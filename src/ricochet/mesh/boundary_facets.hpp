#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The facets of a set of cells, whether or not they belong to a group: which are on its boundary, and how those
/// inside join their cells.
namespace ricochet {

/// A facet as one of its cell's.
struct CellFacet {
  std::size_t block = 0;
  Index cell = 0;
  std::size_t local = 0;
};

/// Those that belong to one cell only, in the order of blocks, cells and their facets. `cells` are a mesh's or a
/// space's.
[[nodiscard]] std::vector<CellFacet> boundary_facets(const std::vector<CellBlock>& cells);

/// A facet that two cells share, as that of each.
struct SharedFacet {
  CellFacet first;
  CellFacet second;
};

/// Those whose two cells lie on the same side of them, so that they overlap: the mesh is folded there. The order in
/// which the cells number the facet's vertices says so; the Jacobian of all cells must be positive.
[[nodiscard]] std::vector<SharedFacet> folds(const std::vector<CellBlock>& cells);

/// The facet's nodes, in the order in which the facet itself numbers them, its vertices first.
[[nodiscard]] std::vector<Index> nodes_of_facet(const std::vector<CellBlock>& cells, const CellFacet& facet);

}  // namespace ricochet
