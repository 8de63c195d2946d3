#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Ordering of nodes that gives neighbours near numbers, and its partition among threads.
namespace ricochet {

/// Returns the nodes in the order of a recursive bisection by their coordinates (d × count). Depends on relative
/// positions only.
[[nodiscard]] std::vector<int> order_nodes(const Points& nodes);

inline constexpr Index most_node_parts = 64;

/// Returns where consecutive parts of `count` nodes begin, followed by `count`: the first cuts of that bisection. The
/// number of parts is a power of two: 1 for a thousand nodes, at most `most_node_parts`.
[[nodiscard]] std::vector<Index> node_parts(Index count);

}  // namespace ricochet
