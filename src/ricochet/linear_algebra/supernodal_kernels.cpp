#include "ricochet/linear_algebra/supernodal_kernels.hpp"

#include "ricochet/base/packs.hpp"
#include "ricochet/linear_algebra/supernode_layout.hpp"

namespace ricochet {

namespace {

/// Prefetch distance in the stream, in numbers.
constexpr Index fetch_stream_ahead = 512;
/// Number of positions at which tall blocks are read concurrently.
constexpr Index streams = 4;
/// Number of panels per position from which on that is worth it.
constexpr Index fewest_panels = 4;

/// Number of panels per position; 0 if there is only one position.
template <StreamCount P>
RICOCHET_PART_OF_CALLER constexpr Index panels_apart(Index rows) {
  const Index panels = P == StreamCount::four ? rows / 8 / streams : 0;
  return panels >= fewest_panels ? panels : 0;
}

template <StreamCount P, int C>
RICOCHET_PART_OF_CALLER void fetch_panel(const double* panel) {
  if constexpr (P == StreamCount::four) {
    for (int j = 0; j < C; ++j) __builtin_prefetch(panel + 8 * j);
  }
}

RICOCHET_PART_OF_CALLER double sum(const Pack<2>& a) { return a[0] + a[1]; }
RICOCHET_PART_OF_CALLER double sum(const Pack<4>& a) { return (a[0] + a[2]) + (a[1] + a[3]); }
RICOCHET_PART_OF_CALLER double sum(const Pack<8>& a) {
  return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

/// Number of rows below a triangle, including the zeros that fill its last panels: remainders of 1 to 7 become 2, 2, 4,
/// 4, 6, 6, 8.
RICOCHET_PART_OF_CALLER constexpr Index filled(Index rows) { return (rows + 1) / 2 * 2; }
template <int H, int C>
RICOCHET_PART_OF_CALLER const double* forward_panel(const double* stream, const double (&x)[C], double* w) {
  Pack<H> product = load<H>(stream) * x[0];
  for (int j = 1; j < C; ++j) product += load<H>(stream + H * j) * x[j];
  store<H>(w, load<H>(w) - product);
  return stream + H * C;
}

template <StreamCount P, int C>
RICOCHET_PART_OF_CALLER const double* forward_block(const double* stream, Index rows_below, double* w) {
  constexpr int lanes = int(triangle_lanes(C));
  Pack<lanes> solved = load<lanes>(stream) * w[0];
  for (int j = 1; j < C; ++j) solved += load<lanes>(stream + lanes * j) * w[j];
  stream += lanes * C;
  double x[C];
  for (int j = 0; j < C; ++j) w[j] = x[j] = solved[j];
  w += C;
  const Index end = filled(rows_below);
  Index row = 0;
  if (const Index apart = 8 * panels_apart<P>(end); apart > 0) {
    for (; row < apart; row += 8, stream += 8 * C) {
      for (Index k = 0; k < streams; ++k) {
        fetch_panel<P, C>(stream + k * apart * C + fetch_stream_ahead);
        forward_panel<8, C>(stream + k * apart * C, x, w + k * apart + row);
      }
    }
    stream += (streams - 1) * apart * C;
    row = streams * apart;
  }
  for (; row + 8 <= end; row += 8) {
    fetch_panel<P, C>(stream + fetch_stream_ahead);
    stream = forward_panel<8, C>(stream, x, w + row);
  }
  if ((end & 4) != 0) {
    stream = forward_panel<4, C>(stream, x, w + row);
    row += 4;
  }
  if ((end & 2) != 0) stream = forward_panel<2, C>(stream, x, w + row);
  return stream;
}

/// Adds Lᵀw of the last rows, a panel of four or two.
template <int H, int C>
RICOCHET_PART_OF_CALLER const double* backward_panel(const double* stream, const double* w, double (&product)[C]) {
  stream -= H * C;
  const Pack<H> values = load<H>(w);
  for (int j = 0; j < C; ++j) product[j] += sum(load<H>(stream + H * j) * values);
  return stream;
}

/// Adds line by line downwards, and the compiler must keep this order: in any other, AMD's processors do not prefetch,
/// which takes twice the time.
template <int C>
RICOCHET_PART_OF_CALLER void add_panel(const double* panel, const double* rows, Pack<8> (&products)[C]) {
  const Pack<8> values = load<8>(rows);
  for (int j = C - 1; j >= 0; --j) {
    products[j] += load<8>(panel + 8 * j) * values;
#if defined(__GNUC__)
    asm volatile("" ::: "memory");
#endif
  }
}

template <StreamCount P, int C>
RICOCHET_PART_OF_CALLER const double* backward_block(const double* stream, Index rows_below, double* w) {
  const Index end = filled(rows_below);
  double* const below = w + C;
  Index row = end;
  double product[C] = {};
  if ((end & 2) != 0) stream = backward_panel<2, C>(stream, below + (row -= 2), product);
  if ((end & 4) != 0) stream = backward_panel<4, C>(stream, below + (row -= 4), product);
  Pack<8> products[C];
  for (int j = 0; j < C; ++j) products[j] = Pack<8>{};
  const Index apart = 8 * panels_apart<P>(end);
  while (row > streams * apart) {
    row -= 8;
    stream -= 8 * C;
    fetch_panel<P, C>(stream - fetch_stream_ahead);
    add_panel<C>(stream, below + row, products);
  }
  while (row > (streams - 1) * apart) {
    row -= 8;
    stream -= 8 * C;
    for (Index k = 0; k < streams; ++k) {
      fetch_panel<P, C>(stream - k * apart * C - fetch_stream_ahead);
      add_panel<C>(stream - k * apart * C, below + row - k * apart, products);
    }
  }
  stream -= (streams - 1) * apart * C;
  constexpr int lanes = int(triangle_lanes(C));
  stream -= lanes * C;
  Pack<lanes> right{};
  for (int j = 0; j < C; ++j) right[j] = w[j] - (sum(products[j]) + product[j]);
  for (int j = 0; j < C; ++j) w[j] = sum(load<lanes>(stream + lanes * j) * right);
  return stream;
}

template <int H, int C>
RICOCHET_PART_OF_CALLER const double* forward_panel_eight(const double* stream, const Pack<8> (&x)[C], double* w) {
  for (int i = 0; i < H; ++i) {
    Pack<8> product = stream[i] * x[0];
    for (int j = 1; j < C; ++j) product += stream[H * j + i] * x[j];
    store<8>(w + 8 * i, load<8>(w + 8 * i) - product);
  }
  return stream + H * C;
}

template <int C>
RICOCHET_PART_OF_CALLER const double* forward_block_eight(const double* stream, Index rows_below, double* w) {
  constexpr int lanes = int(triangle_lanes(C));
  Pack<8> x[C];
  for (int i = 0; i < C; ++i) {
    x[i] = stream[i] * load<8>(w);
    for (int j = 1; j < C; ++j) x[i] += stream[lanes * j + i] * load<8>(w + 8 * j);
  }
  stream += lanes * C;
  for (int j = 0; j < C; ++j) store<8>(w + 8 * j, x[j]);
  w += Index{8} * C;
  const Index end = filled(rows_below);
  Index row = 0;
  for (; row + 8 <= end; row += 8) stream = forward_panel_eight<8, C>(stream, x, w + 8 * row);
  if ((end & 4) != 0) {
    stream = forward_panel_eight<4, C>(stream, x, w + 8 * row);
    row += 4;
  }
  if ((end & 2) != 0) stream = forward_panel_eight<2, C>(stream, x, w + 8 * row);
  return stream;
}

}  // namespace

StreamCount stream_count() {
  // A named instruction set gives the same bits on every processor.
#if defined(__x86_64__) && defined(__GNUC__)
  static const bool one = !instruction_set_is_given() && __builtin_cpu_is("amd") != 0;
  return one ? StreamCount::one : StreamCount::four;
#else
  return StreamCount::four;
#endif
}

template <StreamCount P>
RICOCHET_PART_OF_CALLER const double* forward_blocks(const double* stream, Index columns, Index rows, double* w) {
  Index first = columns % 8;
  with_constant<7>(
      first, [&](auto head) RICOCHET_LAMBDA_OF_CALLER { stream = forward_block<P, head>(stream, rows - head, w); });
  for (; first < columns; first += 8) stream = forward_block<P, 8>(stream, rows - first - 8, w + first);
  return stream;
}

RICOCHET_EACH_INSTRUCTION_SET(const double*, supernode_forward,
                              (const double* stream, Index columns, Index rows, double* w,
                               StreamCount parallel_streams),
                              (stream, columns, rows, w, parallel_streams)) {
  return parallel_streams == StreamCount::one ? forward_blocks<StreamCount::one>(stream, columns, rows, w)
                                              : forward_blocks<StreamCount::four>(stream, columns, rows, w);
}

template <StreamCount P>
RICOCHET_PART_OF_CALLER const double* backward_blocks(const double* stream_end, Index columns, Index rows, double* w) {
  const Index head = columns % 8;
  for (Index first = columns; first > head;) {
    first -= 8;
    stream_end = backward_block<P, 8>(stream_end, rows - first - 8, w + first);
  }
  with_constant<7>(
      head, [&](auto c) RICOCHET_LAMBDA_OF_CALLER { stream_end = backward_block<P, c>(stream_end, rows - c, w); });
  return stream_end;
}

RICOCHET_EACH_INSTRUCTION_SET(const double*, supernode_backward,
                              (const double* stream_end, Index columns, Index rows, double* w,
                               StreamCount parallel_streams),
                              (stream_end, columns, rows, w, parallel_streams)) {
  return parallel_streams == StreamCount::one ? backward_blocks<StreamCount::one>(stream_end, columns, rows, w)
                                              : backward_blocks<StreamCount::four>(stream_end, columns, rows, w);
}

RICOCHET_EACH_INSTRUCTION_SET(const double*, supernode_forward_eight,
                              (const double* stream, Index columns, Index rows, double* w),
                              (stream, columns, rows, w)) {
  Index first = columns % 8;
  with_constant<7>(
      first, [&](auto head) RICOCHET_LAMBDA_OF_CALLER { stream = forward_block_eight<head>(stream, rows - head, w); });
  for (; first < columns; first += 8) stream = forward_block_eight<8>(stream, rows - first - 8, w + 8 * first);
  return stream;
}

RICOCHET_EACH_INSTRUCTION_SET(void, supernode_forward_rows,
                              (Index columns, Index rows_below, const double* stream, double* w),
                              (columns, rows_below, stream, w)) {
  with_constant<8>(
      columns, [&](auto c) RICOCHET_LAMBDA_OF_CALLER { forward_block<StreamCount::one, c>(stream, rows_below, w); });
}

template <StreamCount P, int C>
RICOCHET_PART_OF_CALLER void forward_panels(Index count, const double* stream, const double* columns_of_w, double* w) {
  double x[C];
  for (int j = 0; j < C; ++j) x[j] = columns_of_w[j];
  for (Index panel = 0; panel < count; ++panel, w += 8) {
    fetch_panel<P, C>(stream + fetch_stream_ahead);
    stream = forward_panel<8, C>(stream, x, w);
  }
}

RICOCHET_EACH_INSTRUCTION_SET(void, panels_forward,
                              (Index columns, Index count, const double* stream, const double* x, double* w,
                               StreamCount parallel_streams),
                              (columns, count, stream, x, w, parallel_streams)) {
  with_constant<8>(columns, [&](auto c) RICOCHET_LAMBDA_OF_CALLER {
    parallel_streams == StreamCount::one ? forward_panels<StreamCount::one, c>(count, stream, x, w)
                                         : forward_panels<StreamCount::four, c>(count, stream, x, w);
  });
}

template <StreamCount P, int C>
RICOCHET_PART_OF_CALLER void backward_panels(Index count, const double* stream, const double* w, double* sums) {
  Pack<8> products[C];
  for (int j = 0; j < C; ++j) products[j] = load<8>(sums + 8 * j);
  for (Index panel = 0; panel < count; ++panel, w += 8, stream += 8 * C) {
    const Pack<8> values = load<8>(w);
    fetch_panel<P, C>(stream + fetch_stream_ahead);
    for (int j = 0; j < C; ++j) products[j] += load<8>(stream + 8 * j) * values;
  }
  for (int j = 0; j < C; ++j) store<8>(sums + 8 * j, products[j]);
}

RICOCHET_EACH_INSTRUCTION_SET(void, panels_backward,
                              (Index columns, Index count, const double* stream, const double* w, double* sums,
                               StreamCount parallel_streams),
                              (columns, count, stream, w, sums, parallel_streams)) {
  with_constant<8>(columns, [&](auto c) RICOCHET_LAMBDA_OF_CALLER {
    parallel_streams == StreamCount::one ? backward_panels<StreamCount::one, c>(count, stream, w, sums)
                                         : backward_panels<StreamCount::four, c>(count, stream, w, sums);
  });
}

template <int C>
RICOCHET_PART_OF_CALLER void backward_triangle(const double* triangle, const double* sums, double* w) {
  constexpr int lanes = int(triangle_lanes(C));
  Pack<lanes> right{};
  for (int j = 0; j < C; ++j) right[j] = w[j] - sum(load<8>(sums + 8 * j));
  for (int j = 0; j < C; ++j) w[j] = sum(load<lanes>(triangle + lanes * j) * right);
}

RICOCHET_EACH_INSTRUCTION_SET(void, triangle_backward,
                              (Index columns, const double* triangle, const double* sums, double* w),
                              (columns, triangle, sums, w)) {
  with_constant<8>(columns, [&](auto c) RICOCHET_LAMBDA_OF_CALLER { backward_triangle<c>(triangle, sums, w); });
}

RICOCHET_EACH_INSTRUCTION_SET(void, remainder_forward,
                              (Index columns, Index rows, const double* stream, const double* x, double* w),
                              (columns, rows, stream, x, w)) {
  for (const Index height : {Index{4}, Index{2}}) {
    if ((rows & height) == 0) continue;
    // In the order of forward_panel: the product, then the difference.
    for (Index i = 0; i < height; ++i) {
      double product = stream[i] * x[0];
      for (Index j = 1; j < columns; ++j) product += stream[height * j + i] * x[j];
      w[i] -= product;
    }
    stream += height * columns;
    w += height;
  }
}

RICOCHET_EACH_INSTRUCTION_SET(void, remainder_backward,
                              (Index columns, Index rows, const double* stream, const double* w, double* sums),
                              (columns, rows, stream, w, sums)) {
  for (const Index height : {Index{4}, Index{2}}) {
    if ((rows & height) == 0) continue;
    for (Index j = 0; j < columns; ++j) {
      for (Index i = 0; i < height; ++i) sums[8 * j + i] += stream[height * j + i] * w[i];
    }
    stream += height * columns;
    w += height;
  }
}

}  // namespace ricochet
