#pragma once

#include <vector>

#include "ricochet/linear_algebra/matrix_graph.hpp"

/// @file The bodies of a problem, as its matrices see them.
namespace ricochet {

/// The connected components of a graph, in the order of their first nodes; nodes come in the order in which they are
/// reached from it.
[[nodiscard]] std::vector<std::vector<Index>> graph_components(const MatrixGraph& graph);

}  // namespace ricochet
