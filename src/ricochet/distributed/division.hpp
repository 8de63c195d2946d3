#pragma once

#include <span>
#include <vector>

#include "ricochet/fem/displacement_space.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Which ranks have which nodes of a body, by the cells that they have.
namespace ricochet {

class Division {
 public:
  /// `rank_of_cell`: of partition_cells. A contact point goes where its first node belongs by the cells; the other
  /// nodes that it sees, and those whose pressure it has a part in, go there, too. So does a node where the mass
  /// couples it to one that no other rank has with it.
  Division(const DisplacementSpace& space, const SemidiscreteProblem& problem, std::vector<int> rank_of_cell);

  [[nodiscard]] const std::vector<int>& rank_of_cell() const { return rank_of_cell_; }
  /// The ranks that have a node, ascending. A node belongs to the first.
  [[nodiscard]] std::span<const int> ranks_of(Index node) const {
    const auto at = static_cast<std::size_t>(node);
    return {ranks_.data() + begin_[at], ranks_.data() + begin_[at + 1]};
  }
  [[nodiscard]] int owner(Index node) const { return ranks_of(node).front(); }
  [[nodiscard]] bool has(int rank, Index node) const;
  /// The rank that an entry of a matrix belongs to: the first one that has both nodes.
  [[nodiscard]] int rank_of_pair(Index one, Index other) const;
  [[nodiscard]] int rank_of_point(Index point) const { return rank_of_point_[static_cast<std::size_t>(point)]; }
  /// Ascending.
  [[nodiscard]] std::vector<Index> points_of(int rank) const;
  /// Nodes of a rank that are none of its cells.
  [[nodiscard]] const std::vector<Index>& more_nodes(int rank) const {
    return more_nodes_[static_cast<std::size_t>(rank)];
  }

 private:
  void give(const std::vector<std::vector<Index>>& more);

  std::vector<int> rank_of_cell_, rank_of_point_;
  std::vector<std::size_t> begin_;
  std::vector<int> ranks_;
  std::vector<std::vector<Index>> more_nodes_;
};

}  // namespace ricochet
