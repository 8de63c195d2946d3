#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The division of a mesh among ranks.
namespace ricochet {

enum class PartitionMethod : char {
  graph,   ///< PT-Scotch on the graph of nodes: parts of equal size with short boundaries
  random,  ///< each cell on a random rank: tests with the worst possible boundaries
};

/// Returns the rank of each cell, numbered through all blocks. By graph, nodes are divided, and a cell goes to the rank
/// with most of its nodes, the lowest of equals. There must be at least as many cells as ranks.
[[nodiscard]] std::vector<int> partition_cells(const Mesh& mesh, int ranks, PartitionMethod method,
                                               std::uint64_t seed = 0);

}  // namespace ricochet
