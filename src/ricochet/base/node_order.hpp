#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file An order of nodes in which near ones have near numbers, and its division among threads.
namespace ricochet {

/// The node at each place, in the order of a recursive bisection by their coordinates. Positions: d × count. Depends on
/// them only relative to one another.
[[nodiscard]] std::vector<int> order_nodes(const Points& nodes);

inline constexpr Index most_node_parts = 64;

/// Where consecutive parts of so many nodes begin, and after them the count: the first cuts of that bisection. A power
/// of two of parts: 1 for a thousand nodes, at most `most_node_parts`.
[[nodiscard]] std::vector<Index> node_parts(Index count);

}  // namespace ricochet
