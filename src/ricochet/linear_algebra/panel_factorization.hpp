#pragma once

#include <memory>
#include <vector>

#include "ricochet/linear_algebra/panel_kernels.hpp"
#include "ricochet/linear_algebra/supernodal_factor.hpp"

/// @file A panel of a supernode's columns while it is factorized.
namespace ricochet {

/// The lower triangle of a symmetric matrix by columns.
struct LowerColumns {
  const int* begin = nullptr;  ///< per column, and the end
  const int* rows = nullptr;
  const double* values = nullptr;
};

/// Columns of a panel, at most. Products of a panel with itself have few columns, so it must not be wide.
constexpr Index most_panel_columns = 128;

/// Columns [begin, end) of a supernode, with its rows from `begin` on. The first panel of a supernode has its head, and
/// the others begin where a block begins (linear_algebra/supernode_layout.hpp).
struct FactorPanel {
  int supernode = 0;
  int begin = 0, end = 0;
};

/// The rows [begin, end) of an earlier supernode are columns of a panel.
struct PanelUpdate {
  int source = 0;
  int begin = 0, end = 0;
};

/// What a thread needs besides the factor. To be used for one panel after the other.
struct PanelWorkspace {
  std::unique_ptr<double[]> values;  ///< of the panel, column by column
  std::vector<int> local;            ///< per row of the factor: its place in the panel
  std::vector<int> row_places;       ///< of an update
  /// For factors of so many rows, whose supernodes have at most `most_rows`.
  void allocate(Index size, Index most_rows);
};

class PanelFactorization {
 public:
  /// Keeps references. All supernodes of `updates` are to be complete, and the panels before this one in its own.
  PanelFactorization(SupernodalFactor& factor, const FactorPanel& panel, PanelWorkspace& workspace);

  [[nodiscard]] Index rows() const { return rows_; }
  /// Rows [begin, end), before they are divided by the triangle: A's entries less what earlier columns contribute, in
  /// the order of `updates` [first, last). Parts of the rows may be assembled at the same time, each with `places` of
  /// its own. Throws std::logic_error at an entry of A outside the rows of the factor.
  void assemble(const LowerColumns& matrix, double scale, const PanelUpdate* first, const PanelUpdate* last,
                Index begin, Index end, std::vector<int>& places);
  /// The triangle of the panel's own columns. Returns the first whose pivot is not positive, or −1.
  Index factorize_triangle();
  /// The rows below come in groups.
  [[nodiscard]] Index groups() const {
    return (layout_.panels() - end_block_ + panels_per_group - 1) / panels_per_group +
           (layout_.remainder() > 0 ? 1 : 0);
  }
  /// Some of them; several ranges may be solved at the same time.
  void solve_groups(Index begin, Index end);

 private:
  /// Columns of a supernode: of its head and of the blocks before `end_block`.
  struct Source {
    SupernodeLayout layout;
    const double* base;
    Index end_block;
  };
  void subtract(const Source& source, Index row_begin, Index row_end, const int* row_places, Index column_begin,
                Index column_end, const int* column_places);
  [[nodiscard]] PanelRows own_rows(Index panel) const {
    return {base_ + layout_.head_panel(panel), base_ + layout_.panel(first_block_, panel), layout_.stride(first_block_),
            64};
  }
  void solve(Index panel, Index count, const PanelRows& rows, Index end_block, double* head_result,
             double* block_result);
  [[nodiscard]] const double* at(Index row, Index column) const {
    return values_ + (column - panel_.begin) * stride_ + row - panel_.begin;
  }

  SupernodalFactor& factor_;
  FactorPanel panel_;
  const SupernodalFactor::Supernode& node_;
  SupernodeLayout layout_;
  double* base_;
  Index rows_, stride_;
  bool has_head_;
  Index first_block_, end_block_;
  double* values_;
  int* local_;
};

}  // namespace ricochet
