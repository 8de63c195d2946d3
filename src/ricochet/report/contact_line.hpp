#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The contact boundary as the abscissa of plots: in the plane, its nodes from end to end.
namespace ricochet {

/// Nodes of the contact boundary. In the plane they follow one another along its pieces; a piece starts at its left (or
/// else lower) end, a closed one at its node with the lowest number. In space they are ordered by number.
struct ContactLine {
  std::vector<Index> nodes;
  std::vector<double> position;  ///< in the plane: arc length in the reference configuration, with gaps of a
                                 ///< twentieth of the whole between pieces; empty in space
  std::vector<int> pieces;       ///< in the plane: start of each piece in `nodes`
};

/// `nodes`: 3 × count.
[[nodiscard]] ContactLine make_contact_line(const Points& nodes, const std::vector<CellBlock>& facets);

}  // namespace ricochet
