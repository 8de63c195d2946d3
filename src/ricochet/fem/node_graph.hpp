#pragma once

#include <vector>

#include "ricochet/base/node_order.hpp"
#include "ricochet/fem/displacement_space.hpp"

/// @file Which nodes share a cell: the pattern of assembled matrices, and a division of the work of assembling them.
namespace ricochet {

struct NodeGraph {
  /// Neighbours of each node, itself among them: row by row, ascending.
  std::vector<Index> offsets;
  std::vector<int> neighbours;

  /// Parts of near nodes (node_parts). One thread at a time works on the rows of a part.
  std::vector<Index> part_begins;
  /// The cells (numbered through all blocks) that touch the nodes of each part, ascending. Those between two parts are
  /// listed in both.
  std::vector<Index> cell_begins;
  std::vector<int> cells;

  [[nodiscard]] Index node_count() const { return static_cast<Index>(offsets.size()) - 1; }
  [[nodiscard]] Index parts() const { return static_cast<Index>(part_begins.size()) - 1; }
};
[[nodiscard]] NodeGraph node_graph(const DisplacementSpace& space);
/// The same with those cells alone that touch a wanted node.
[[nodiscard]] NodeGraph cells_at_nodes(const NodeGraph& graph, const DisplacementSpace& space,
                                       const std::vector<char>& wanted);

/// Walks through cells in ascending order of their number through all blocks.
class CellWalk {
 public:
  explicit CellWalk(const std::vector<CellBlock>& blocks) : blocks_(blocks) {}
  /// Goes to a cell whose number is not less than the last one.
  void go_to(Index number) {
    while (number - first_ >= blocks_[block_].size()) first_ += blocks_[block_++].size();
    local_ = number - first_;
  }
  [[nodiscard]] std::size_t block() const { return block_; }
  /// Number within the block.
  [[nodiscard]] Index local() const { return local_; }
  [[nodiscard]] const Index* nodes() const { return blocks_[block_].cell(local_); }
  [[nodiscard]] int node_count() const { return blocks_[block_].nodes_per_cell; }

 private:
  const std::vector<CellBlock>& blocks_;
  std::size_t block_ = 0;
  Index first_ = 0, local_ = 0;
};

}  // namespace ricochet
