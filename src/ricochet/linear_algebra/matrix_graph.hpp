#pragma once

#include <span>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_pattern.hpp"

/// @file Adjacency graph of the nodes of a matrix.
namespace ricochet {

class MatrixGraph {
 public:
  MatrixGraph() = default;
  /// Makes the graph of a matrix with a symmetric pattern and d rows per node: nodes that share an entry are
  /// neighbours.
  MatrixGraph(const SparseMatrix& matrix, int d);
  explicit MatrixGraph(const NodePattern& pattern);

  [[nodiscard]] Index size() const { return Index(begin_.size()) - 1; }
  /// Neighbours of a node, ascending, including the node itself.
  [[nodiscard]] std::span<const int> neighbours(Index node) const {
    const auto at = std::size_t(node);
    return {neighbour_.data() + begin_[at], neighbour_.data() + begin_[at + 1]};
  }

 private:
  std::vector<Index> begin_{0};
  std::vector<int> neighbour_;
};

/// Nodes in the neighbourhood of given ones, with the number of steps to the nearest of these.
struct NodeDistances {
  std::vector<Index> nodes;   ///< the given ones first, then layer after layer
  std::vector<int> distance;  ///< of each of them
  [[nodiscard]] std::vector<Index> ascending() const;
};
/// Returns the nodes within `layers` steps of `first`, which may contain nodes more than once.
[[nodiscard]] NodeDistances nodes_within(const MatrixGraph& graph, const std::vector<Index>& first, int layers);

}  // namespace ricochet
