#include "ricochet/mesh/search/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace ricochet {

constexpr int things_of_leaf = 4;

BoxTree::BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  build(boxes, 0, int(order_.size()));
  refit(boxes);
}

/// Builds a subtree and returns the number of its root.
int BoxTree::build(const std::vector<Box>& boxes, int first, int last) {
  const int number = int(nodes_.size());
  nodes_.push_back({{}, first, last - first, 0});
  if (last - first <= things_of_leaf) return number;
  const auto middle_of = [&](int thing) -> Eigen::Vector3d { return boxes[std::size_t(thing)].center(); };
  Box middles;
  for (int i = first; i < last; ++i) middles.extend(middle_of(order_[std::size_t(i)]));
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const int half = (first + last) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last, [&](int a, int b) {
    const double left = middle_of(a)[axis], right = middle_of(b)[axis];
    return left != right ? left < right : a < b;
  });
  nodes_[std::size_t(number)].count = 0;
  build(boxes, first, half);
  const int second = build(boxes, half, last);
  nodes_[std::size_t(number)].second = second;
  return number;
}

/// From the last node to the first, since descendants follow a node.
void BoxTree::refit(const std::vector<Box>& boxes) {
  for (std::size_t number = nodes_.size(); number-- > 0;) {
    Node& node = nodes_[number];
    node.box.setEmpty();
    if (node.count == 0) node.box.extend(nodes_[number + 1].box).extend(nodes_[std::size_t(node.second)].box);
    for (int i = node.first; i < node.first + node.count; ++i)
      node.box.extend(boxes[std::size_t(order_[std::size_t(i)])]);
  }
}

}  // namespace ricochet
