#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The inside of a solid in tetrahedra, which a page cuts by planes.
namespace ricochet {

/// Tetrahedra of a solid. Hexahedra are several tetrahedra, and so are cells of degree 2 if the size allows it.
struct Volume {
  std::vector<Index> nodes;     ///< number of each node in the body
  std::vector<int> tetrahedra;  ///< count × 4, indices in `nodes`
  std::vector<int> cells;       ///< cell of each tetrahedron in the body
  std::vector<int> faces;       ///< per tetrahedron: bit k is set if the face opposite to its corner k lies on a facet
                                ///< of the cell
  bool is_thinned = false;      ///< neighbouring nodes were merged

  [[nodiscard]] Index count() const { return static_cast<Index>(cells.size()); }
};

/// `nodes`: 3 × count; plane cells have no volume. If there are more tetrahedra than `most`, cells of degree 2 are
/// represented by their vertices; if these are still too many, neighbouring nodes are merged.
[[nodiscard]] Volume make_volume(const Points& nodes, const std::vector<CellBlock>& cells, Index most);

}  // namespace ricochet
