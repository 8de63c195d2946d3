#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file An order of nodes in which near ones have near numbers.
namespace ricochet {

/// Nodes in the order of a recursive bisection by their coordinates, cut into consecutive parts. Depends on positions
/// only relative to one another, and not on the number of threads.
struct NodeOrder {
  static constexpr Index most_parts = 64;

  std::vector<int> node;      ///< the node at each place
  std::vector<int> place;     ///< the place of each node
  std::vector<Index> begins;  ///< of the parts, and after them the number of nodes
  [[nodiscard]] Index size() const { return static_cast<Index>(node.size()); }
  [[nodiscard]] Index parts() const { return static_cast<Index>(begins.size()) - 1; }
};

/// Positions: d × count. A power of two of parts: 1 for a thousand nodes, at most `most_parts`.
[[nodiscard]] NodeOrder order_nodes(const Points& nodes);

}  // namespace ricochet
