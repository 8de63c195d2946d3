#include "ricochet/linear_algebra/panel_kernels.hpp"

#include <cmath>
#include <utility>

#include "ricochet/base/packs.hpp"

namespace ricochet {

namespace {

/// The 8 × C numbers of each of P panels, in registers of H: pack i of all is rows [H i, H i + H) of the 8 P. They are
/// unrolled by the indices of a template, column by column, because a compiler keeps in memory the elements that a loop
/// iterates over.
template <int H, int P, int C, typename = std::make_integer_sequence<int, P * 8 / H * C>>
struct Sums;
template <int H, int P, int C, int... all>
struct Sums<H, P, C, std::integer_sequence<int, all...>> {
  static constexpr Index panel_of(int sum) { return sum % (P * 8 / H) * H / 8; }
  static constexpr Index row_of(int sum) { return sum % (P * 8 / H) * H % 8; }
  static constexpr Index column_of(int sum) { return sum / (P * 8 / H); }

  /// Adds the product of a column of the panels, `apart` from one another, and C numbers of B.
  RICOCHET_PART_OF_CALLER void add(const double* a, Index apart, const double* b) {
    ((values[all] += load<H>(a + panel_of(all) * apart + row_of(all)) * b[column_of(all)]), ...);
  }
  RICOCHET_PART_OF_CALLER void write(double* c) const {
    (store<H>(c + 64 * panel_of(all) + 8 * column_of(all) + row_of(all), values[all]), ...);
  }

  Pack<H> values[sizeof...(all)] = {(static_cast<void>(all), Pack<H>{})...};
};

/// Computes columns `first` … `first` + C − 1 of the product of P panels.
template <int H, int P, int C>
RICOCHET_PART_OF_CALLER void multiply(const PanelRows& a, const PanelRows& b, PanelColumns columns, Index first,
                                      double* c) {
  Sums<H, P, C> sums;
  for (Index k = 0; k < columns.head; ++k) sums.add(a.head + 8 * k, 8 * columns.head, b.head + first + 8 * k);
  const double *left = a.blocks, *right = b.blocks + first;
  Index left_stride = a.stride, right_stride = b.stride;
  for (Index block = 0; block < columns.blocks; ++block) {
    for (int k = 0; k < 8; ++k) sums.add(left + 8 * k, 64, right + 8 * k);
    left += left_stride;
    right += right_stride;
    left_stride -= a.shrink;
    right_stride -= b.shrink;
  }
  sums.write(c + 8 * first);
}

/// Multiplies one panel after the other, C columns at a time: for processors with sixteen registers.
template <int H, int C>
RICOCHET_PART_OF_CALLER void multiply_one_by_one(Index count, PanelRows a, const PanelRows& b, PanelColumns columns,
                                                 double* c) {
  for (Index p = 0; p < count; ++p, c += 64) {
    for (Index first = 0; first < 8; first += C) multiply<H, 1, C>(a, b, columns, first, c);
    a.head += 8 * columns.head;
    a.blocks += 64;
  }
}

template <int C>
RICOCHET_PART_OF_CALLER void solve_columns(const double* c, const double* inverse, double* x) {
  constexpr int lanes = int(triangle_lanes(C));
  for (int i = 0; i < C; ++i) {
    Pack<8> sum = load<8>(c) * inverse[i];
    for (int j = 1; j <= i; ++j) sum += load<8>(c + 8 * j) * inverse[lanes * j + i];
    store<8>(x + 8 * i, sum);
  }
}

#if defined(__x86_64__) && defined(__GNUC__)
/// Uses as many numbers as the registers of the processor hold.
__attribute__((target("arch=x86-64-v4"))) void multiply_avx512(Index count, const PanelRows& a, const PanelRows& b,
                                                               PanelColumns columns, double* c) {
  switch (count) {
    case 3:
      return multiply<8, 3, 8>(a, b, columns, 0, c);
    case 2:
      return multiply<8, 2, 8>(a, b, columns, 0, c);
    default:
      return multiply<8, 1, 8>(a, b, columns, 0, c);
  }
}
__attribute__((target("arch=x86-64-v3"))) void multiply_avx2(Index count, const PanelRows& a, const PanelRows& b,
                                                             PanelColumns columns, double* c) {
  multiply_one_by_one<4, 4>(count, a, b, columns, c);
}
#endif

}  // namespace

void multiply_panels(Index count, const PanelRows& a, const PanelRows& b, PanelColumns columns, double* c) {
#if defined(__x86_64__) && defined(__GNUC__)
  const InstructionSet set = instruction_set();
  if (set == InstructionSet::avx512) return multiply_avx512(count, a, b, columns, c);
  if (set == InstructionSet::avx2) return multiply_avx2(count, a, b, columns, c);
#endif
  multiply_one_by_one<2, 2>(count, a, b, columns, c);
}

RICOCHET_EACH_INSTRUCTION_SET(void, subtract_panel,
                              (const double* c, const PanelTarget& rows, const PanelTarget& columns, double* matrix,
                               Index stride),
                              (c, rows, columns, matrix, stride)) {
  const int* const indices = rows.indices;
  if (rows.begin == 0 && rows.end == 8 && indices[7] - indices[0] == 7) {
    for (Index j = columns.begin; j < columns.end; ++j) {
      double* const to = matrix + columns.indices[j] * stride + indices[0];
      store<8>(to, load<8>(to) - load<8>(c + 8 * j));
    }
    return;
  }
  for (Index j = columns.begin; j < columns.end; ++j) {
    double* const to = matrix + columns.indices[j] * stride;
    for (Index i = rows.begin; i < rows.end; ++i) to[indices[i]] -= c[8 * j + i];
  }
}

RICOCHET_EACH_INSTRUCTION_SET(void, subtract_from, (const double* a, Index stride, Index columns, double* c),
                              (a, stride, columns, c)) {
  for (Index j = 0; j < columns; ++j) store<8>(c + 8 * j, load<8>(a + j * stride) - load<8>(c + 8 * j));
}

RICOCHET_EACH_INSTRUCTION_SET(void, solve_panel, (Index size, const double* c, const double* inverse, double* x),
                              (size, c, inverse, x)) {
  with_constant<8>(size, [&](auto columns) RICOCHET_LAMBDA_OF_CALLER { solve_columns<columns>(c, inverse, x); });
}

int invert_factor(Index size, const double* triangle, double* inverse) {
  double factor[8][8];
  for (Index j = 0; j < size; ++j) {
    for (Index i = j; i < size; ++i) {
      double value = triangle[8 * j + i];
      for (Index k = 0; k < j; ++k) value -= factor[k][i] * factor[k][j];
      if (i > j) {
        factor[j][i] = value / factor[j][j];
      } else if (value > 0.0) {
        factor[j][j] = std::sqrt(value);
      } else {
        return int(j);
      }
    }
  }
  const Index lanes = triangle_lanes(size);
  for (Index j = 0; j < size; ++j) {
    for (Index i = 0; i < lanes; ++i) inverse[lanes * j + i] = 0.0;
    inverse[lanes * j + j] = 1.0 / factor[j][j];
    for (Index i = j + 1; i < size; ++i) {
      double product = 0.0;
      for (Index k = j; k < i; ++k) product += factor[k][i] * inverse[lanes * j + k];
      inverse[lanes * j + i] = -product / factor[i][i];
    }
  }
  return -1;
}

}  // namespace ricochet
