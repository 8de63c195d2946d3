#pragma once

#include <vector>

#include "ricochet/base/large_vector.hpp"
#include "ricochet/base/types.hpp"

/// @file Blocks of a symmetric matrix that a NodeMatrix stores, and their order. Not part of the public interface.
namespace ricochet {

/// Rows of one part with equal numbers of blocks. The blocks of a row are consecutive, as are those of consecutive
/// rows: first the two-sided ones, with columns right of the row in its part, then the one-sided ones, which are on the
/// diagonal or belong to other parts. Columns ascend in each.
struct RowGroup {
  Index first_row = 0, rows = 0;  ///< in NodePattern::node
  Index first_block = 0;
  Index two_sided = 0, one_sided = 0;  ///< of each row
  [[nodiscard]] Index blocks_per_row() const { return two_sided + one_sided; }
  [[nodiscard]] Index end_row() const { return first_row + rows; }
};

/// Blocks of one row.
struct PatternRow {
  Index first_block = 0, two_sided = 0, one_sided = 0;
};
using PatternRows = std::vector<PatternRow>;  ///< per node

/// Pattern of a NodeMatrix. The rows of a part are sorted by their numbers of blocks: if the length of the inner loop
/// changed from row to row, the processor would mispredict the end of each, which costs as much as the products. A part
/// is small enough for its vectors to stay in the near caches in any order of its rows.
struct NodePattern {
  std::vector<Index> part_begins{0};  ///< node_parts
  std::vector<int> node;              ///< of each row, part after part
  LargeVector<int> column;            ///< per block: node of the column
  std::vector<RowGroup> groups;       ///< part after part
  std::vector<Index> part_groups{0};  ///< first group of each part, followed by the number of groups

  [[nodiscard]] Index parts() const { return Index(part_begins.size()) - 1; }
  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] PatternRows rows() const;
  /// Calls enter(node of the row, its first block, the group with its numbers of blocks) for the rows of these parts.
  template <class Enter>
  void visit_rows(Index first_part, Index end_part, const Enter& enter) const {
    for (Index g = part_groups[std::size_t(first_part)]; g < part_groups[std::size_t(end_part)]; ++g) {
      const RowGroup& group = groups[std::size_t(g)];
      Index block = group.first_block;
      for (Index row = group.first_row; row < group.end_row(); ++row, block += group.blocks_per_row())
        enter(node[std::size_t(row)], block, group);
    }
  }
};

/// Returns the pattern of a symmetric matrix with d dofs per node, stored whole and compressed. If `alike`, the matrix
/// is m ⊗ I and only the columns of the first components are read.
[[nodiscard]] NodePattern node_pattern(const SparseMatrix& matrix, int d, bool alike);

/// Returns the union of some patterns of the same nodes.
[[nodiscard]] NodePattern joined_pattern(const std::vector<const NodePattern*>& patterns);

}  // namespace ricochet
