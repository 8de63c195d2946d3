#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file The bodies of a problem, as its matrices see them.
namespace ricochet {

/// The connected components of the graph of a matrix with a symmetric pattern, whose node i has the rows
/// i × node_size, …: nodes that share an entry are in one. Components come in the order of their first nodes, nodes in
/// the order in which they are reached from it. The pattern is that of each node's first row.
[[nodiscard]] std::vector<std::vector<Index>> graph_components(const SparseMatrix& matrix, Index node_size);

}  // namespace ricochet
