#pragma once

#include <vector>

#include "ricochet/base/node_order.hpp"
#include "ricochet/fem/displacement_space.hpp"

/// @file Graph of nodes that share a cell: the sparsity pattern of assembled matrices, and the
/// partition of the assembly work.
namespace ricochet {

struct NodeGraph {
  /// Neighbours of each node, including itself: row by row, ascending.
  std::vector<Index> offsets;
  std::vector<int> neighbours;

  /// Parts of nearby nodes (node_parts). The rows of a part are processed by one thread at a time.
  std::vector<Index> part_begins;
  /// Cells (numbered through all blocks) at the nodes of each part, ascending. Cells between
  /// two parts are listed in both.
  std::vector<Index> cell_begins;
  std::vector<int> cells;

  [[nodiscard]] Index node_count() const { return Index(offsets.size()) - 1; }
  [[nodiscard]] Index parts() const { return Index(part_begins.size()) - 1; }
};
[[nodiscard]] NodeGraph node_graph(const DisplacementSpace& space);
/// Restricts the graph to the cells with at least one selected node.
[[nodiscard]] NodeGraph cells_at_nodes(const NodeGraph& graph, const DisplacementSpace& space,
                                       const std::vector<char>& is_selected);

/// Iterator over cells in ascending order of their number through all blocks.
class CellWalk {
 public:
  explicit CellWalk(const std::vector<CellBlock>& blocks) : blocks_(blocks) {}
  /// Advances to a cell whose number is not less than the current one.
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
