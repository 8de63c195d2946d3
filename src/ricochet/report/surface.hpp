#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The visible surface of a body in triangles: the whole body in the plane, its boundary in space.
namespace ricochet {

/// Triangles of the surface; cells of degree 2 are several flat triangles. Neighbouring nodes have close numbers.
struct Surface {
  std::vector<Index> nodes;    ///< number of each node in the body
  std::vector<int> triangles;  ///< count × 3, indices in `nodes`
  std::vector<int> cells;      ///< cell of each triangle in the body
  std::vector<int> edges;      ///< per triangle: bit k is set if the side from its corner k to the next lies on an
                               ///< edge of a cell
  bool is_thinned = false;     ///< triangles were merged

  [[nodiscard]] Index triangle_count() const { return static_cast<Index>(cells.size()); }
};

/// `nodes`: 3 × count. If there are more triangles than `most`, neighbouring nodes are merged until there are fewer.
[[nodiscard]] Surface make_surface(const Points& nodes, const std::vector<CellBlock>& cells, Index most);

}  // namespace ricochet
