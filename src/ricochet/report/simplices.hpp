#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Triangles of the visible surface of a body, and tetrahedra of the inside of a solid, which a page cuts by
/// planes.
namespace ricochet {

/// Triangles or tetrahedra, of which a cell may be several. Neighbouring nodes have close numbers.
struct Simplices {
  std::vector<Index> nodes;  ///< number of each node in the body
  std::vector<int> corners;  ///< count × 3 or count × 4, indices in `nodes`
  std::vector<int> cells;    ///< cell of each simplex in the body
  /// Per simplex: bit k is set if its side k lies on a side of the cell. Side k of a triangle is that from its corner k
  /// to the next; of a tetrahedron, that opposite to its corner k.
  std::vector<int> sides;
  bool is_thinned = false;  ///< neighbouring nodes were merged

  [[nodiscard]] Index count() const { return Index(cells.size()); }
};

/// Returns the triangles of the whole body in the plane, of its boundary in space. `nodes`: 3 × count. If there are
/// more than `most`, neighbouring nodes are merged until there are fewer.
[[nodiscard]] Simplices make_surface(const Points& nodes, const std::vector<CellBlock>& cells, Index most);

/// Returns the tetrahedra of a solid; plane cells have none. If there are more than `most`, cells of degree 2 are
/// represented by their vertices; if these are still too many, neighbouring nodes are merged.
[[nodiscard]] Simplices make_volume(const Points& nodes, const std::vector<CellBlock>& cells, Index most);

}  // namespace ricochet
