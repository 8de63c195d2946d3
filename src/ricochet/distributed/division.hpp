#pragma once

#include <span>
#include <vector>

#include "ricochet/fem/displacement_space.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Distribution of the nodes of a body over ranks, according to their cells.
namespace ricochet {

class Division {
 public:
  /// `rank_of_cell` as returned by partition_cells. A contact point belongs to the rank that owns its first node by the
  /// cells; its other nodes, and those to whose pressure it contributes, are added to that rank. A node is also added
  /// to a rank if the mass couples it to a node with which it shares no rank.
  Division(const DisplacementSpace& space, const SemidiscreteProblem& problem, std::vector<int> rank_of_cell);

  [[nodiscard]] const std::vector<int>& rank_of_cell() const { return rank_of_cell_; }
  /// Returns the ranks that have a node, ascending. The first of them owns the node.
  [[nodiscard]] std::span<const int> ranks_of(Index node) const {
    const auto at = std::size_t(node);
    return {ranks_.data() + begin_[at], ranks_.data() + begin_[at + 1]};
  }
  [[nodiscard]] int owner(Index node) const { return ranks_of(node).front(); }
  [[nodiscard]] bool has(int rank, Index node) const;
  /// Returns the rank to which an entry of a matrix belongs: the first that has both nodes; −1 if none.
  [[nodiscard]] int rank_of_pair(Index one, Index other) const;
  [[nodiscard]] int rank_of_point(Index point) const { return rank_of_point_[std::size_t(point)]; }
  /// Returns the points of a rank, ascending.
  [[nodiscard]] std::vector<Index> points_of(int rank) const;
  /// Returns the nodes of a rank that are not on its cells.
  [[nodiscard]] const std::vector<Index>& more_nodes(int rank) const { return more_nodes_[std::size_t(rank)]; }

 private:
  void add_nodes(const std::vector<std::vector<Index>>& more);

  std::vector<int> rank_of_cell_, rank_of_point_;
  std::vector<std::size_t> begin_;
  std::vector<int> ranks_;
  std::vector<std::vector<Index>> more_nodes_;
};

}  // namespace ricochet
