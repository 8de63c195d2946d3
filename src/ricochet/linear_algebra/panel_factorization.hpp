#pragma once

#include <memory>
#include <vector>

#include "ricochet/linear_algebra/panel_kernels.hpp"
#include "ricochet/linear_algebra/supernodal_factor.hpp"

/// @file A panel of a supernode's columns while it is factorized.
namespace ricochet {

/// Lower triangle of a symmetric matrix by columns.
struct LowerColumns {
  const int* begin = nullptr;  ///< per column, and the end
  const int* rows = nullptr;
  const double* values = nullptr;
};

/// Largest number of columns of a panel. Products of a panel with itself have few columns, so it must not be wide.
constexpr Index max_panel_columns = 128;

/// Columns [begin, end) of a supernode, with its rows from `begin` on. The first panel of a supernode contains its
/// head, and the others begin where a block begins (linear_algebra/supernode_layout.hpp).
struct FactorPanel {
  int supernode = 0;
  int begin = 0, end = 0;
};

/// Contribution of an earlier supernode, whose rows [begin, end) are columns of the panel.
struct PanelUpdate {
  int source = 0;
  int begin = 0, end = 0;
};

/// Memory that a thread needs besides the factor, reused from panel to panel.
struct PanelWorkspace {
  std::unique_ptr<double[]> values;  ///< of the panel, column by column
  std::vector<int> local;            ///< per row of the factor: its index in the panel
  std::vector<int> relative_rows;    ///< of an update
  /// Allocates for factors with `size` rows, whose supernodes have at most `max_rows`.
  void allocate(Index size, Index max_rows);
};

class PanelFactorization {
 public:
  /// Keeps references. All supernodes that the updates of assemble() name must be complete, and so must the earlier
  /// panels of its own supernode.
  PanelFactorization(SupernodalFactor& factor, const FactorPanel& panel, PanelWorkspace& workspace);

  [[nodiscard]] Index rows() const { return rows_; }
  /// Assembles rows [begin, end), before they are divided by the triangle: A's entries minus the contributions of
  /// earlier columns, in the order of the updates [first, last). Parts of the rows may be assembled in parallel, each
  /// with its own `row_storage`. Throws std::logic_error if A has an entry outside the rows of the factor.
  void assemble(const LowerColumns& matrix, double scale, const PanelUpdate* first, const PanelUpdate* last,
                Index begin, Index end, std::vector<int>& row_storage);
  /// Factorizes the triangle of the panel's own columns. Returns the first whose pivot is not positive, or −1.
  Index factorize_triangle();
  /// Number of groups of the rows below.
  [[nodiscard]] Index groups() const {
    return (layout_.panels() - end_block_ + panels_per_group - 1) / panels_per_group +
           (layout_.remainder() > 0 ? 1 : 0);
  }
  /// Solves groups [begin, end); several ranges may be solved in parallel.
  void solve_groups(Index begin, Index end);

 private:
  /// Columns of a supernode: those of its head and of the blocks before `end_block`.
  struct Source {
    SupernodeLayout layout;
    const double* base;
    Index end_block;
  };
  void subtract(const Source& source, Index row_begin, Index row_end, const int* relative_rows, Index column_begin,
                Index column_end, const int* relative_columns);
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
