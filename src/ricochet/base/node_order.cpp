#include "ricochet/base/node_order.hpp"

#include <algorithm>
#include <numeric>

namespace ricochet {

namespace {

/// Sorts the nodes [begin, end) so that those of the first half precede those of the second along the longest side of
/// their bounding box, and recursively within the halves, down to a few nodes.
void bisect(const Points& nodes, int* begin, int* end) {
  constexpr Index few = 16;
  if (end - begin <= few) return;
  const Index dimension = nodes.rows();
  Eigen::Array3d low = Eigen::Array3d::Zero(), high = Eigen::Array3d::Zero();
  low.head(dimension) = high.head(dimension) = nodes.col(*begin).array();
  for (const int* node = begin; node != end; ++node) {
    low.head(dimension) = low.head(dimension).min(nodes.col(*node).array());
    high.head(dimension) = high.head(dimension).max(nodes.col(*node).array());
  }
  Index axis = 0;
  (high - low).maxCoeff(&axis);
  int* middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [&](int a, int b) {
    return nodes(axis, a) < nodes(axis, b) || (nodes(axis, a) == nodes(axis, b) && a < b);
  });
  bisect(nodes, begin, middle);
  bisect(nodes, middle, end);
}

/// Appends the indices at which the first `levels` bisections cut.
void cuts(Index begin, Index end, int levels, std::vector<Index>& begins) {
  if (levels == 0) {
    begins.push_back(begin);
    return;
  }
  const Index middle = begin + (end - begin) / 2;
  cuts(begin, middle, levels - 1, begins);
  cuts(middle, end, levels - 1, begins);
}

}  // namespace

std::vector<int> order_nodes(const Points& nodes) {
  std::vector<int> order(static_cast<std::size_t>(nodes.cols()));
  std::iota(order.begin(), order.end(), 0);
  bisect(nodes, order.data(), order.data() + order.size());
  return order;
}

std::vector<Index> node_parts(Index count) {
  // Parts of this size depend little on one another, and no more of them are needed to keep the threads busy.
  constexpr Index least_part = 1024;
  int levels = 0;
  while (Index{2} << levels <= most_node_parts && (count >> (levels + 1)) >= least_part) ++levels;
  std::vector<Index> begins;
  cuts(0, count, levels, begins);
  begins.push_back(count);
  return begins;
}

}  // namespace ricochet
