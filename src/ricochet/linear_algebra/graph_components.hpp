#pragma once

#include <vector>

#include "ricochet/linear_algebra/matrix_graph.hpp"

/// @file Connected components of a matrix graph: the bodies of a problem.
namespace ricochet {

/// Returns the connected components of a graph in the order of their first nodes, each with its nodes in the order in
/// which they are reached from the first.
[[nodiscard]] std::vector<std::vector<Index>> graph_components(const MatrixGraph& graph);

}  // namespace ricochet
