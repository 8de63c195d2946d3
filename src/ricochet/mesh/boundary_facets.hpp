#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The boundary of a set of cells, whether or not its facets belong to a group.
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

/// The facet's nodes, in the order in which the facet itself numbers them, its vertices first.
[[nodiscard]] std::vector<Index> nodes_of_facet(const std::vector<CellBlock>& cells, const CellFacet& facet);

}  // namespace ricochet
