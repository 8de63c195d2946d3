#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Connected sets of numbered things.
namespace ricochet {

/// Disjoint sets of the numbers 0, 1, …, each alone at first, joined two by two. The smallest number of a set
/// represents it.
class DisjointSets {
 public:
  explicit DisjointSets(Index count) : parent_(std::size_t(count)) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  /// Returns the representative of a number's set, halving paths on the way.
  [[nodiscard]] Index root(Index number) {
    const auto parent = [this](Index i) -> Index& { return parent_[std::size_t(i)]; };
    while (parent(number) != number) number = parent(number) = parent(parent(number));
    return number;
  }
  void join(Index one, Index other) {
    const Index a = root(one), b = root(other);
    parent_[std::size_t(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace ricochet
