#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file What of a body can be seen, in triangles: the whole body in the plane, its boundary in space.
namespace ricochet {

/// Cells of degree 2 are several flat triangles. Nodes that are near one another have near numbers.
struct Surface {
  std::vector<Index> nodes;    ///< the body's number of each node
  std::vector<int> triangles;  ///< count × 3, numbers in `nodes`
  std::vector<int> cells;      ///< the body's cell of each triangle
  std::vector<int> edges;      ///< of each triangle: bit k is set where the side from its corner k to the next belongs
                               ///< to an edge of a cell
  bool is_thinned = false;     ///< triangles were merged

  [[nodiscard]] Index triangle_count() const { return static_cast<Index>(cells.size()); }
};

/// `nodes`: 3 × count. With more triangles than `most` nodes that are near one another are merged, until there are
/// fewer.
[[nodiscard]] Surface make_surface(const Points& nodes, const std::vector<CellBlock>& cells, Index most);

}  // namespace ricochet
