#include "ricochet/report/node_grid.hpp"

#include <algorithm>
#include <utility>

namespace ricochet {

namespace {

/// Interleaves the bits of x, y and z (Morton order), so that boxes with close numbers are close to one another.
std::uint64_t interleaved(const GridBox& box) {
  std::uint64_t result = 0;
  for (unsigned bit = 0; bit < 20; ++bit) {
    for (unsigned k = 0; k < 3; ++k) result |= std::uint64_t(box[k] >> bit & 1U) << (3 * bit + k);
  }
  return result;
}

}  // namespace

NodeGrid::NodeGrid(const Points& nodes, double boxes) : low_(nodes.rowwise().minCoeff()) {
  const double longest = (nodes.rowwise().maxCoeff() - low_).maxCoeff();
  scale_ = longest > 0.0 ? boxes / longest : 0.0;
}

GridBox NodeGrid::box(const Points& nodes, Index node) const {
  GridBox result{};
  for (Index k = 0; k < 3; ++k) result[std::size_t(k)] = std::uint32_t((nodes(k, node) - low_[k]) * scale_);
  return result;
}

std::vector<Index> sorted_unique(std::vector<Index> numbers) {
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::vector<Index> spatially_sorted(const Points& nodes, const std::vector<Index>& chosen) {
  const NodeGrid grid(nodes, 1048575.0);
  std::vector<std::pair<std::uint64_t, Index>> order;
  order.reserve(chosen.size());
  for (const Index node : chosen) order.emplace_back(interleaved(grid.box(nodes, node)), node);
  std::ranges::sort(order);
  std::vector<Index> result;
  result.reserve(order.size());
  for (const auto& [position, node] : order) result.push_back(node);
  return result;
}

std::vector<int> local_numbers(const std::vector<Index>& chosen, Index count) {
  std::vector<int> local(static_cast<std::size_t>(count), -1);
  for (std::size_t i = 0; i < chosen.size(); ++i) local[std::size_t(chosen[i])] = int(i);
  return local;
}

}  // namespace ricochet
