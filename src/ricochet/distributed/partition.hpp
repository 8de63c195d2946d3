#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file The division of a mesh among ranks.
namespace ricochet {

enum class PartitionMethod : char {
  graph,   ///< PT-Scotch on the graph of nodes: parts of one size with short boundaries
  random,  ///< each cell anywhere, by a seed: for tests, as no rank then has a boundary that it could be lucky with
};

/// The rank of each cell, numbered through all blocks. By graph: nodes are divided, and a cell goes where most of its
/// nodes are, of equals to the first. There are at least as many cells as ranks.
[[nodiscard]] std::vector<int> partition_cells(const Mesh& mesh, int ranks, PartitionMethod method,
                                               std::uint64_t seed = 0);

}  // namespace ricochet
