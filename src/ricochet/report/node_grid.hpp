#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Nodes by their places: boxes of a grid that put near nodes together, an order in which near nodes have near
/// numbers.
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

/// Ascending, without repetitions.
[[nodiscard]] std::vector<Index> each_once(std::vector<Index> numbers);
/// The same nodes, such that those near one another have near places in the list.
[[nodiscard]] std::vector<Index> by_place(const Points& nodes, const std::vector<Index>& chosen);
/// Of `count` nodes the place of each in the list; −1: it is not there.
[[nodiscard]] std::vector<int> local_numbers(const std::vector<Index>& chosen, Index count);

}  // namespace ricochet
