#pragma once

#include <utility>
#include <vector>

#include "ricochet/base/types.hpp"

namespace ricochet {

/// Rings of nodes around a node in the graph of a symmetric matrix, by breadth-first search.
class GraphRings {
 public:
  /// Refers to the matrix.
  explicit GraphRings(const SparseMatrix& graph) : graph_(graph), visited_by_(std::size_t(graph.cols()), -1) {}

  void start(Index node) {
    front_.assign(1, start_ = node);
    visited_by_[std::size_t(node)] = node;
  }
  /// Visits each node of the next ring; returns false if it has none.
  template <class Visit>
  bool grow(const Visit& visit) {
    next_.clear();
    for (const Index from : front_) {
      for (SparseMatrix::InnerIterator entry(graph_, from); entry; ++entry) {
        Index& visited_by = visited_by_[std::size_t(entry.row())];
        if (visited_by == start_) continue;
        visited_by = start_;
        next_.push_back(entry.row());
        visit(next_.back());
      }
    }
    std::swap(front_, next_);
    return !front_.empty();
  }
  /// Returns the start and all nodes visited since, ascending.
  [[nodiscard]] std::vector<Index> nodes() const {
    std::vector<Index> result;
    for (std::size_t node = 0; node < visited_by_.size(); ++node) {
      if (visited_by_[node] == start_) result.push_back(Index(node));
    }
    return result;
  }

 private:
  const SparseMatrix& graph_;
  std::vector<Index> visited_by_;  ///< per node, the start from which it was last reached
  std::vector<Index> front_, next_;
  Index start_ = -1;
};

}  // namespace ricochet
