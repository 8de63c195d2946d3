#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/base/ranks.hpp"

/// @file Nodes of a body that is divided among ranks, gathered on one of them, the root.
namespace ricochet {

class GatheredNodes {
 public:
  GatheredNodes() = default;
  /// `nodes` are those of this rank, in any order; a node named by one of its ranks is named by all. At the root they
  /// are numbered by their numbers in the whole body, except that those of `first` come first, as they are numbered
  /// there.
  GatheredNodes(const Ranks& ranks, int root_rank, const std::vector<Index>& nodes,
                const GatheredNodes* first = nullptr);

  [[nodiscard]] int root() const { return root_; }
  [[nodiscard]] bool is_root() const { return ranks_->rank() == root_; }
  /// Nodes of this rank, ascending.
  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
  /// Number of nodes of all ranks, at the root; elsewhere 0.
  [[nodiscard]] Index count() const { return Index(numbers_.size()); }
  /// Index, at the root, of a node with this number in the whole body, or −1.
  [[nodiscard]] Index index_of(std::int64_t number) const;

  /// Gathers consistent values, so many per node of this rank, at the root, per node there; elsewhere empty.
  [[nodiscard]] Vector gather(const Vector& values, int per_node) const;
  /// Sends values at the root to each rank that has the node; those of other nodes are unchanged.
  void scatter(const Vector& at_root, int per_node, Vector& values) const;

 private:
  const Ranks* ranks_ = nullptr;
  int root_ = 0;
  std::vector<Index> nodes_, owned_;
  std::vector<std::int64_t> numbers_;                        ///< at the root, per index
  std::vector<std::pair<std::int64_t, Index>> index_;        ///< at the root, by number
  std::vector<std::vector<Index>> indices_, owned_indices_;  ///< at the root, of the nodes of each rank
};

}  // namespace ricochet
