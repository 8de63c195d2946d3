#include "ricochet/linear_algebra/matrix_graph.hpp"

#include <algorithm>
#include <unordered_set>

namespace ricochet {

MatrixGraph::MatrixGraph(const SparseMatrix& matrix, int d) {
  const Index nodes = matrix.cols() / d;
  begin_.reserve(std::size_t(nodes) + 1);
  neighbour_.reserve(std::size_t(matrix.nonZeros() / (d * d) + nodes));
  for (Index node = 0; node < nodes; ++node) {
    for (int a = 0; a < d; ++a) {
      int last = -1;
      for (SparseMatrix::InnerIterator entry(matrix, node * d + a); entry; ++entry) {
        const int other = int(entry.row()) / d;
        if (other != last) neighbour_.push_back(other);
        last = other;
      }
    }
    const auto first = neighbour_.begin() + begin_.back();
    std::sort(first, neighbour_.end());
    neighbour_.erase(std::unique(first, neighbour_.end()), neighbour_.end());
    begin_.push_back(Index(neighbour_.size()));
  }
}

MatrixGraph::MatrixGraph(const NodePattern& pattern) : begin_(pattern.node.size() + 1, 0) {
  const auto each = [&](const auto& enter) {
    pattern.visit_rows(0, pattern.parts(), [&](int node, Index first_block, const RowGroup& group) {
      for (Index k = 0; k < group.blocks_per_row(); ++k) {
        const int other = pattern.column[std::size_t(first_block + k)];
        enter(node, other);
        if (k < group.two_sided) enter(other, node);
      }
    });
  };
  each([&](int node, int) { ++begin_[std::size_t(node) + 1]; });
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  neighbour_.resize(std::size_t(begin_.back()));
  std::vector<Index> next(begin_.begin(), begin_.end() - 1);
  each([&](int node, int other) { neighbour_[std::size_t(next[std::size_t(node)]++)] = other; });
  for (std::size_t i = 0; i + 1 < begin_.size(); ++i)
    std::sort(neighbour_.begin() + begin_[i], neighbour_.begin() + begin_[i + 1]);
}

std::vector<Index> NodeDistances::ascending() const {
  std::vector<Index> result = nodes;
  std::ranges::sort(result);
  return result;
}

NodeDistances nodes_within(const MatrixGraph& graph, const std::vector<Index>& first, int layers) {
  NodeDistances result;
  std::unordered_set<Index> reached;
  const auto reach = [&](Index node, int distance) {
    if (!reached.insert(node).second) return;
    result.nodes.push_back(node);
    result.distance.push_back(distance);
  };
  for (const Index node : first) reach(node, 0);
  std::size_t begin = 0;
  for (int distance = 1; distance <= layers; ++distance) {
    const std::size_t end = result.nodes.size();
    for (; begin < end; ++begin) {
      for (const int other : graph.neighbours(result.nodes[begin])) reach(other, distance);
    }
  }
  return result;
}

}  // namespace ricochet
