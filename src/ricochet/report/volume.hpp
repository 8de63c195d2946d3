#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The inside of a solid in tetrahedra, which a page cuts by planes.
namespace ricochet {

/// Hexahedra, and cells of degree 2 as far as there is room, are several tetrahedra.
struct Volume {
  std::vector<Index> nodes;     ///< the body's number of each node
  std::vector<int> tetrahedra;  ///< count × 4, numbers in `nodes`
  std::vector<int> cells;       ///< the body's cell of each tetrahedron
  std::vector<int> faces;   ///< of each tetrahedron: bit k is set where the face opposite to its corner k belongs to
                            ///< a facet of the cell
  bool is_thinned = false;  ///< nodes near one another were merged

  [[nodiscard]] Index count() const { return static_cast<Index>(cells.size()); }
};

/// `nodes`: 3 × count; of plane cells there is no volume. With more tetrahedra than `most`, cells of degree 2 are those
/// of their vertices; where these are still too many, nodes that are near one another are merged.
[[nodiscard]] Volume make_volume(const Points& nodes, const std::vector<CellBlock>& cells, Index most);

}  // namespace ricochet
