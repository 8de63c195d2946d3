#pragma once

#include "ricochet/base/types.hpp"

/// @file Storage layout of the numbers of a supernode, in the order in which a triangular solve reads them.
///
/// A supernode has k columns and m ≥ k rows, the first k of which are its own. Its columns are cut into the head, which
/// has k mod 8 columns, and blocks of eight. A block with c columns and n rows below its triangle is stored as
///   - the inverse of its c × c triangle in column-major order, each column padded with zeros to 2, 4 or 8 numbers;
///   - the n rows below in panels of eight rows, the last ones of four and two (an odd row padded with zeros); a panel
///   is stored in column-major order.
/// Hence a forward solve reads one ascending stream of numbers and a backward solve the same stream descending. As the
/// head comes first, panels hold the same rows in all blocks, and a product of two panels' rows reads eight by eight
/// numbers as one contiguous piece: the factorization has nothing to pack.
namespace ricochet {

/// Stored numbers per column of the inverse of a triangle.
[[nodiscard]] constexpr Index triangle_lanes(Index columns) { return columns <= 2 ? 2 : columns <= 4 ? 4 : 8; }

struct SupernodeLayout {
  Index head = 0;    ///< columns of the head; 0: there is none
  Index blocks = 0;  ///< of eight columns
  Index rows = 0;    ///< below the head's own, with the zeros that fill the last panel: even

  constexpr SupernodeLayout(Index columns, Index all_rows)
      : head(columns % 8), blocks(columns / 8), rows((all_rows - columns % 8 + 1) / 2 * 2) {}

  /// Number of full panels; panel p has the rows head + 8p … head + 8p + 7. The remaining rows form panels of four and
  /// two, if any.
  [[nodiscard]] constexpr Index panels() const { return rows / 8; }
  [[nodiscard]] constexpr Index remainder() const { return rows % 8; }

  [[nodiscard]] constexpr Index head_size() const { return head == 0 ? 0 : (triangle_lanes(head) + rows) * head; }
  /// Offset of a panel in the head.
  [[nodiscard]] constexpr Index head_panel(Index panel) const { return (triangle_lanes(head) + 8 * panel) * head; }
  /// Offset of a panel in block b, whose triangle is stored where its panel b would be. The panel of the next block is
  /// `stride` further on.
  [[nodiscard]] constexpr Index panel(Index block, Index panel) const {
    return head_size() + 8 * block * rows - 32 * block * (block - 1) + 64 * (panel - block);
  }
  [[nodiscard]] constexpr Index stride(Index block) const { return 8 * rows - 64 * (block + 1); }
  [[nodiscard]] constexpr Index size() const { return panel(blocks, blocks); }
};

}  // namespace ricochet
