#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

/// @file Axis-aligned boxes in a tree, to find the items that may be near.
namespace ricochet {

/// A binary tree over items given by their boxes, in three coordinates (the third is 0 in the plane). A node's items
/// are halved along the longest side of the box around their centres; ties are resolved by number. Hence the tree
/// depends on the boxes alone. Nothing is allocated after construction.
class BoxTree {
 public:
  using Box = Eigen::AlignedBox3d;
  struct Node {
    Box box;
    int first = 0, count = 0;  ///< items (in `order`) of a leaf; count 0: two children, the next node and `second`
    int second = 0;
  };
  static constexpr std::size_t max_depth = 64;  ///< longest path from the root to a leaf

  BoxTree() = default;
  /// `boxes` must not be empty.
  explicit BoxTree(const std::vector<Box>& boxes);
  /// Updates the boxes of the same items.
  void refit(const std::vector<Box>& boxes);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  /// A node precedes its descendants; the first is the root.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Items in the order of the leaves.
  [[nodiscard]] const std::vector<int>& order() const { return order_; }

  /// Calls visit(item) for the items of all leaves that `may_touch(box)` accepts, in an order that depends on the tree
  /// alone.
  template <class MayTouch, class Visit>
  void visit(const MayTouch& may_touch, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<int, max_depth> waiting{};
    std::size_t count = 1;
    while (count > 0) {
      const int number = waiting[--count];
      const Node& node = nodes_[std::size_t(number)];
      if (!may_touch(node.box)) continue;
      for (int i = node.first; i < node.first + node.count; ++i) visit(order_[std::size_t(i)]);
      if (node.count > 0) continue;
      waiting[count++] = node.second;
      waiting[count++] = number + 1;
    }
  }

 private:
  int build(const std::vector<Box>& boxes, int first, int last);

  std::vector<Node> nodes_;
  std::vector<int> order_;
};

}  // namespace ricochet
