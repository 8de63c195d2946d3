#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The contact boundary as something to plot along: in the plane its nodes from end to end.
namespace ricochet {

/// Nodes of the contact boundary. In the plane they follow one another along its pieces; a piece starts at its left (or
/// else lower) end, a closed one at its node of the lowest number. In space they are in the order of their numbers.
struct ContactLine {
  std::vector<Index> nodes;
  std::vector<double> position;  ///< in the plane: arc length in the reference configuration, counted on over gaps
                                 ///< between pieces of a twentieth of the whole; empty in space
  std::vector<int> pieces;       ///< in the plane: where in `nodes` each piece begins
};

/// `nodes`: 3 × count.
[[nodiscard]] ContactLine make_contact_line(const Points& nodes, const std::vector<CellBlock>& facets);

}  // namespace ricochet
