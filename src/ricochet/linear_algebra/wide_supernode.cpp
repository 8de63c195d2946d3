#include "ricochet/linear_algebra/wide_supernode.hpp"

#include <algorithm>

#include "ricochet/base/parallel.hpp"
#include "ricochet/linear_algebra/supernodal_kernels.hpp"

namespace ricochet {

namespace {

/// Blocks of eight columns in a strip: its triangle should take little time compared with its rows.
constexpr Index strip_blocks = 16;
constexpr Index strip_columns = 8 * strip_blocks + 8;
/// Bounds for the parts below a strip.
constexpr Index max_parts = 16, min_part_panels = 8;
/// Number of parts that a thread reads concurrently if that is faster, and number of panels read from each in turn.
constexpr Index max_streams = 4, panels_in_turn = 8;
/// A supernode with at least so many numbers is wide: half a megabyte takes longer to read than threads to synchronize.
constexpr Index min_size = Index{1} << 16;

/// Calls visit(part, panel, count) for the panels of parts [first, last), so that a few parts take turns.
template <class Parts, class Visit>
void in_turns(const Parts& parts, Index first, Index last, const Visit& visit) {
  const Index streams = stream_count() == StreamCount::one ? 1 : max_streams;
  for (Index group = first; group < last; group += streams) {
    const Index group_end = std::min(group + streams, last);
    bool more = true;
    for (Index done = 0; more; done += panels_in_turn) {
      more = false;
      for (Index part = group; part < group_end; ++part) {
        const Index at = parts.at(part) + done, end = parts.at(part + 1);
        if (at >= end) continue;
        visit(part, at, std::min(panels_in_turn, end - at));
        more = true;
      }
    }
  }
}

}  // namespace

bool WideSupernode::is_wide(Index columns, Index rows) {
  return columns >= 32 && SupernodeLayout(columns, rows).size() >= min_size;
}

Index WideSupernode::sums_size() { return 8 * strip_columns * max_parts; }

Index WideSupernode::strips() const { return (layout_.blocks + strip_blocks - 1) / strip_blocks; }

WideSupernode::Strip WideSupernode::strip(Index number) const {
  const Index count = strips();
  return {number == 0 ? layout_.head : 0, layout_.blocks * number / count, layout_.blocks * (number + 1) / count};
}

WideSupernode::Parts WideSupernode::parts(const Strip& strip) const {
  const Index below = layout_.panels() - strip.end;
  return {strip.end, layout_.panels(), std::clamp<Index>(below / min_part_panels, 1, max_parts)};
}

void WideSupernode::forward_rows(const Strip& strip, const Parts& parts, Index first, Index last, double* w) const {
  const double* const x = w + (strip.head > 0 ? 0 : layout_.head + 8 * strip.begin);
  double* const rows = w + layout_.head;
  const auto subtract = [&](Index columns, const double* of, const auto& panel_at) {
    in_turns(parts, first, last, [&](Index, Index panel, Index count) {
      panels_forward(columns, count, numbers_ + panel_at(panel), of, rows + 8 * panel);
    });
    if (last == parts.count)
      remainder_forward(columns, layout_.remainder(), numbers_ + panel_at(parts.end), of, rows + 8 * parts.end);
  };
  if (strip.head > 0) subtract(strip.head, x, [&](Index panel) { return layout_.head_panel(panel); });
  for (Index block = strip.begin; block < strip.end; ++block)
    subtract(8, x + strip.head + 8 * (block - strip.begin), [&](Index panel) { return layout_.panel(block, panel); });
}

void WideSupernode::backward_rows(const Strip& strip, const Parts& parts, Index first, Index last, const double* w,
                                  double* sums) const {
  const double* const rows = w + layout_.head;
  const auto add = [&](Index columns, Index column, const auto& panel_at) {
    const auto sums_of = [&](Index part) { return sums + 8 * (strip_columns * part + column); };
    in_turns(parts, first, last, [&](Index part, Index panel, Index count) {
      panels_backward(columns, count, numbers_ + panel_at(panel), rows + 8 * panel, sums_of(part));
    });
    if (last == parts.count)
      remainder_backward(columns, layout_.remainder(), numbers_ + panel_at(parts.end), rows + 8 * parts.end,
                         sums_of(last - 1));
  };
  for (Index part = first; part < last; ++part) std::fill_n(sums + 8 * strip_columns * part, 8 * strip_columns, 0.0);
  if (strip.head > 0) add(strip.head, 0, [&](Index panel) { return layout_.head_panel(panel); });
  for (Index block = strip.begin; block < strip.end; ++block)
    add(8, strip.head + 8 * (block - strip.begin), [&](Index panel) { return layout_.panel(block, panel); });
}

void WideSupernode::forward(double* w) const {
  for (Index number = 0; number < strips(); ++number) {
    const Strip own = strip(number);
    const Parts below = parts(own);
    if (own.head > 0) supernode_forward_rows(own.head, 8 * own.end, numbers_, w);
    for (Index block = own.begin; block < own.end; ++block)
      supernode_forward_rows(8, 8 * (own.end - block - 1), numbers_ + layout_.panel(block, block),
                             w + layout_.head + 8 * block);
    parallel_ranges(below.count, [&](Index first, Index last) { forward_rows(own, below, first, last, w); });
  }
}

void WideSupernode::backward(double* w, double* sums) const {
  for (Index number = strips(); number-- > 0;) {
    const Strip own = strip(number);
    const Parts below = parts(own);
    parallel_ranges(below.count, [&](Index first, Index last) { backward_rows(own, below, first, last, w, sums); });
    const auto solve = [&](Index columns, Index column, const double* triangle, Index panels, double* at) {
      double total[64];
      std::copy_n(sums + 8 * column, 8 * columns, total);
      for (Index part = 1; part < below.count; ++part) {
        const double* const more = sums + 8 * (strip_columns * part + column);
        for (Index k = 0; k < 8 * columns; ++k) total[k] += more[k];
      }
      panels_backward(columns, panels, triangle + triangle_lanes(columns) * columns, at + columns, total);
      triangle_backward(columns, triangle, total, at);
    };
    for (Index block = own.end; block-- > own.begin;)
      solve(8, own.head + 8 * (block - own.begin), numbers_ + layout_.panel(block, block), own.end - block - 1,
            w + layout_.head + 8 * block);
    if (own.head > 0) solve(own.head, 0, numbers_, own.end, w);
  }
}

}  // namespace ricochet
