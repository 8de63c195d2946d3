#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Nodes sorted by position: boxes of a grid that collect neighbouring nodes, and an order in which neighbouring
/// nodes have close numbers.
namespace ricochet {

using GridBox = std::array<std::uint32_t, 3>;

/// A grid over the body with so many boxes along its longest side.
class NodeGrid {
 public:
  NodeGrid(const Points& nodes, double boxes);
  [[nodiscard]] GridBox box(const Points& nodes, Index node) const;

 private:
  Vector low_;
  double scale_ = 0.0;
};

/// Returns the numbers in ascending order, without repetitions.
[[nodiscard]] std::vector<Index> sorted_unique(std::vector<Index> numbers);
/// Returns the same nodes, ordered such that neighbouring nodes are close to each other in the list.
[[nodiscard]] std::vector<Index> spatially_sorted(const Points& nodes, const std::vector<Index>& chosen);
/// Returns, for each of `count` nodes, its index in the list; −1 if it is not in the list.
[[nodiscard]] std::vector<int> local_numbers(const std::vector<Index>& chosen, Index count);

}  // namespace ricochet
