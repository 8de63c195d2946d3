#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/base/ranks.hpp"

/// @file Nodes of a body that is divided among ranks, gathered on one of them.
namespace ricochet {

class GatheredNodes {
 public:
  GatheredNodes() = default;
  /// `nodes`: of this rank, in any order; a node that one of its ranks names is named by all. At home they are numbered
  /// by their numbers in the whole body, but those of `first` come first, as they are numbered there.
  GatheredNodes(const Ranks& ranks, int home, const std::vector<Index>& nodes, const GatheredNodes* first = nullptr);

  [[nodiscard]] int home() const { return home_; }
  [[nodiscard]] bool is_home() const { return ranks_->rank() == home_; }
  /// Of this rank, ascending.
  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
  /// At home, of all ranks; elsewhere 0.
  [[nodiscard]] Index count() const { return static_cast<Index>(numbers_.size()); }
  /// At home, of a node with this number in the whole body; −1: it is none of these.
  [[nodiscard]] Index place_of(std::int64_t number) const;

  /// Of consistent values, so many per node of this rank, those at home, per node there; elsewhere empty.
  [[nodiscard]] Vector gather(const Vector& values, int per_node) const;
  /// From values at home to each rank that has a node; those of other nodes stay as they are.
  void spread(const Vector& at_home, int per_node, Vector& values) const;

 private:
  const Ranks* ranks_ = nullptr;
  int home_ = 0;
  std::vector<Index> nodes_, owned_;
  std::vector<std::int64_t> numbers_;                      ///< at home, of each place
  std::vector<std::pair<std::int64_t, Index>> place_;      ///< at home, by number
  std::vector<std::vector<Index>> places_, owned_places_;  ///< at home, of the nodes of each rank
};

}  // namespace ricochet
