#include "ricochet/linear_algebra/panel_factorization.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace ricochet {

namespace {

/// Number of blocks of eight columns that a product processes at once: two operands of that width fit into the cache.
constexpr Index blocks_at_once = 32;
/// Number of panels of eight rows that are multiplied by one panel after the other while they are in the cache.
constexpr Index panels_at_once = 24;
constexpr Index max_columns_at_once = 8 * blocks_at_once + 8;
/// Entries before and behind a range may be pointed to, but are not read.
constexpr Index margin = 8;

/// The last rows of a supernode, fewer than eight, as a panel of eight.
class Remainder {
 public:
  /// `head`: number of columns of the head in the range.
  explicit Remainder(Index head = 0) : head_(8 * head) {}
  /// Reads columns: those of the head if `head` is true, then blocks [begin, end).
  void read(const SupernodeLayout& layout, const double* base, bool head, Index begin, Index end) {
    if (layout.remainder() == 0) return;
    double* to = values_.data();
    if (head) to = read_block(layout, base + layout.head_panel(layout.panels()), layout.head, to);
    head_ = head ? 8 * layout.head : 0;
    for (Index block = begin; block < end; ++block)
      to = read_block(layout, base + layout.panel(block, layout.panels()), 8, to);
  }
  [[nodiscard]] PanelRows rows() const { return {values_.data(), values_.data() + head_, 64, 0}; }
  double* data() { return values_.data(); }

  void write(const SupernodeLayout& layout, double* base, bool head, Index begin, Index end) const {
    const double* from = values_.data();
    if (head) from = write_block(layout, from, layout.head, base + layout.head_panel(layout.panels()));
    for (Index block = begin; block < end; ++block)
      from = write_block(layout, from, 8, base + layout.panel(block, layout.panels()));
  }

 private:
  static double* read_block(const SupernodeLayout& layout, const double* from, Index columns, double* to) {
    std::fill_n(to, 8 * columns, 0.0);
    Index row = 0;
    for (const Index height : {Index{4}, Index{2}}) {
      if ((layout.remainder() & height) == 0) continue;
      for (Index j = 0; j < columns; ++j, from += height) std::copy_n(from, height, to + 8 * j + row);
      row += height;
    }
    return to + 8 * columns;
  }
  static const double* write_block(const SupernodeLayout& layout, const double* from, Index columns, double* to) {
    Index row = 0;
    for (const Index height : {Index{4}, Index{2}}) {
      if ((layout.remainder() & height) == 0) continue;
      for (Index j = 0; j < columns; ++j, to += height) std::copy_n(from + 8 * j + row, height, to);
      row += height;
    }
    return from + 8 * columns;
  }

  std::array<double, 8 * max_columns_at_once> values_;
  Index head_;
};

}  // namespace

void PanelWorkspace::allocate(Index size, Index max_rows) {
  // Not initialized here: a thread that processes parts of other threads' panels never touches these pages.
  values = std::make_unique_for_overwrite<double[]>(std::size_t((max_rows + 2 * margin) * (max_panel_columns + 8)));
  local.resize(std::size_t(size));
  relative_rows.resize(std::size_t(max_rows + 2 * margin));
}

PanelFactorization::PanelFactorization(SupernodalFactor& factor, const FactorPanel& panel, PanelWorkspace& workspace)
    : factor_(factor),
      panel_(panel),
      node_(factor_.supernode(panel_.supernode)),
      layout_(node_.columns, node_.columns + node_.below),
      base_(factor_.numbers(node_)),
      rows_(node_.columns + node_.below - panel_.begin),
      stride_((rows_ + 15) / 8 * 8),
      has_head_(panel_.begin == 0 && layout_.head > 0),
      first_block_((panel_.begin - (has_head_ ? 0 : layout_.head)) / 8),
      end_block_((panel_.end - layout_.head) / 8),
      values_(workspace.values.get()),
      local_(workspace.local.data()) {
  for (Index i = 0; i < rows_; ++i) local_[factor_.row(node_, panel_.begin + i)] = int(i);
}

void PanelFactorization::assemble(const LowerColumns& matrix, double scale, const PanelUpdate* first,
                                  const PanelUpdate* last, Index begin, Index end, std::vector<int>& row_storage) {
  const Index columns = panel_.end - panel_.begin;
  for (Index j = 0; j < columns; ++j) {
    double* const column = values_ + j * stride_;
    std::fill(column + begin, column + (end == rows_ ? stride_ : end), 0.0);
    const int at = node_.first + int(panel_.begin + j);
    for (int k = matrix.begin[at]; k < matrix.begin[at + 1]; ++k) {
      const int row = local_[matrix.rows[k]];
      // Rows that are not in this panel still have indices of an earlier one.
      if (row >= rows_ || factor_.row(node_, panel_.begin + row) != matrix.rows[k])
        throw std::logic_error("a matrix that is factorized again has an entry where the first one had none");
      if (row >= begin && row < end) column[row] = scale * matrix.values[k];
    }
  }
  int* const relative_rows = row_storage.data() + margin;
  std::array<int, max_panel_columns + 8 + 2 * margin> column_storage;
  int* const relative_columns = column_storage.data() + margin;
  if (panel_.begin > 0) {
    for (Index i = begin; i < end; ++i) relative_rows[i - begin] = int(i);
    for (Index j = 0; j < columns; ++j) relative_columns[j] = int(j);
    subtract({layout_, base_, first_block_}, panel_.begin + begin, panel_.begin + end, relative_rows, panel_.begin,
             panel_.end, relative_columns);
  }
  for (; first != last; ++first) {
    const PanelUpdate& update = *first;
    const SupernodalFactor::Supernode& node = factor_.supernode(update.source);
    const Index size = node.columns + node.below;
    const auto relative_index = [&](Index row) { return local_[factor_.row(node, row)]; };
    const auto first_at = [&](Index target, Index from) {
      Index low = from, high = size;
      while (low < high) {
        const Index middle = (low + high) / 2;
        if (relative_index(middle) < target) {
          low = middle + 1;
        } else {
          high = middle;
        }
      }
      return low;
    };
    const Index row_begin = begin == 0 ? update.begin : first_at(begin, update.begin);
    const Index row_end = end == rows_ ? size : first_at(end, row_begin);
    if (row_begin == row_end) continue;
    for (Index i = row_begin; i < row_end; ++i) relative_rows[i - row_begin] = relative_index(i);
    for (Index j = update.begin; j < update.end; ++j) relative_columns[j - update.begin] = relative_index(j);
    const SupernodeLayout layout(node.columns, size);
    subtract({layout, factor_.numbers(node), layout.blocks}, row_begin, row_end, relative_rows, update.begin,
             update.end, relative_columns);
  }
}

void PanelFactorization::subtract(const Source& source, Index row_begin, Index row_end, const int* relative_rows,
                                  Index column_begin, Index column_end, const int* relative_columns) {
  const SupernodeLayout& layout = source.layout;
  const Index head = layout.head, panels = layout.panels();
  const Index first = (row_begin - head) / 8, last = std::min((row_end - head + 7) / 8, panels);
  const Index first_column = (column_begin - head) / 8, last_column = (column_end - head + 7) / 8;
  const bool has_remainder = row_end > head + 8 * panels;
  Remainder remainder;
  double product[64 * panels_per_group];
  for (Index block = 0; block == 0 || block < source.end_block; block += blocks_at_once) {
    const Index count = std::min(blocks_at_once, source.end_block - block);
    const bool with_head = head > 0 && block == 0;
    const PanelColumns columns{with_head ? head : 0, count};
    if (has_remainder) remainder.read(layout, source.base, with_head, block, block + count);
    const auto rows_of = [&](Index panel) {
      if (panel == panels) return remainder.rows();
      return PanelRows{source.base + layout.head_panel(panel), source.base + layout.panel(block, panel),
                       layout.stride(block), 64};
    };
    const auto target_of = [head](Index panel, Index begin, Index end, const int* all) {
      const Index at = head + 8 * panel;
      return PanelTarget{std::max<Index>(0, begin - at), std::min<Index>(8, end - at), all + (at - begin)};
    };
    const auto multiply = [&](Index panel, Index many, Index column) {
      multiply_panels(many, rows_of(panel), rows_of(column), columns, product);
      const PanelTarget column_range = target_of(column, column_begin, column_end, relative_columns);
      for (Index p = 0; p < many; ++p) {
        subtract_panel(product + 64 * p, target_of(panel + p, row_begin, row_end, relative_rows), column_range, values_,
                       stride_);
      }
    };
    for (Index from = first; from < last; from += panels_at_once) {
      const Index to = std::min(from + panels_at_once, last);
      for (Index column = first_column; column < last_column; ++column) {
        for (Index panel = std::max(from, column); panel < to; panel += panels_per_group)
          multiply(panel, std::min(panels_per_group, to - panel), column);
      }
    }
    if (!has_remainder) continue;
    for (Index column = first_column; column < last_column; ++column) multiply(panels, 1, column);
  }
}

/// Solves for the rows of `count` panels from `panel` on, in the head and in the blocks before `end_block`; for the
/// remainder, results go to `block_result`, one block after the other.
void PanelFactorization::solve(Index panel, Index count, const PanelRows& rows, Index end_block, double* head_result,
                               double* block_result) {
  const Index head = layout_.head;
  double c[64 * panels_per_group];
  if (has_head_) {
    for (Index p = 0; p < count; ++p) {
      std::fill_n(c, 64, 0.0);
      subtract_from(at(head + 8 * (panel + p), 0), stride_, head, c);
      solve_panel(head, c, base_, head_result + 8 * head * p);
    }
  }
  for (Index block = first_block_; block < end_block; ++block) {
    multiply_panels(count, rows, own_rows(block), {has_head_ ? head : 0, block - first_block_}, c);
    double* const result =
        block_result != nullptr ? block_result + 64 * (block - first_block_) : base_ + layout_.panel(block, panel);
    for (Index p = 0; p < count; ++p) {
      subtract_from(at(head + 8 * (panel + p), head + 8 * block), stride_, 8, c + 64 * p);
      solve_panel(8, c + 64 * p, base_ + layout_.panel(block, block), result + 64 * p);
    }
  }
}

Index PanelFactorization::factorize_triangle() {
  const Index head = layout_.head;
  double c[64] = {};
  if (has_head_) {
    for (Index j = 0; j < head; ++j) std::copy_n(at(0, j), head, c + 8 * j);
    if (const int failed = invert_factor(head, c, base_); failed >= 0) return node_.first + failed;
  }
  for (Index block = first_block_; block < end_block_; ++block) {
    const PanelRows rows = own_rows(block);
    solve(block, 1, rows, block, base_ + layout_.head_panel(block), nullptr);
    multiply_panels(1, rows, rows, {has_head_ ? head : 0, block - first_block_}, c);
    subtract_from(at(head + 8 * block, head + 8 * block), stride_, 8, c);
    if (const int failed = invert_factor(8, c, base_ + layout_.panel(block, block)); failed >= 0)
      return node_.first + head + 8 * block + failed;
  }
  return -1;
}

void PanelFactorization::solve_groups(Index begin, Index end) {
  for (Index group = begin; group < end; ++group) {
    const Index panel = end_block_ + group * panels_per_group;
    if (panel < layout_.panels()) {
      solve(panel, std::min(panels_per_group, layout_.panels() - panel), own_rows(panel), end_block_,
            base_ + layout_.head_panel(panel), nullptr);
      continue;
    }
    const Index head = has_head_ ? layout_.head : 0;
    Remainder remainder(head);
    solve(layout_.panels(), 1, remainder.rows(), end_block_, remainder.data(), remainder.data() + 8 * head);
    remainder.write(layout_, base_, has_head_, first_block_, end_block_);
  }
}

}  // namespace ricochet
