#include "ricochet/linear_algebra/node_kernels.hpp"

#include <algorithm>

#include "ricochet/base/packs.hpp"

namespace ricochet {

namespace {

/// Prefetch distance in the stream of blocks, in numbers: it makes a product from memory a quarter to a third faster.
constexpr Index fetch_blocks_ahead = 640;

/// A block acts on the d numbers of a node. `Sums` accumulates A x of a row in several sums, so that additions need not
/// wait for one another; `Own` holds the numbers of the row's node for the products with transposed blocks.
template <int d, bool scalar>
struct Block;

/// Block m ⊗ I: one number.
template <int d>
struct Block<d, true> {
  static constexpr Index numbers = 1;
  struct Own {
    double x[d];
  };
  struct Sums {
    double of[d] = {};
  };
  RICOCHET_PART_OF_CALLER static Own own(const double* x) {
    Own result;
    for (int a = 0; a < d; ++a) result.x[a] = x[a];
    return result;
  }
  RICOCHET_PART_OF_CALLER static void add(const double* block, const double* x, Sums& sums) {
    for (int a = 0; a < d; ++a) sums.of[a] += block[0] * x[a];
  }
  RICOCHET_PART_OF_CALLER static void add_transposed(const double* block, const Own& own, double* y) {
    for (int a = 0; a < d; ++a) y[a] += block[0] * own.x[a];
  }
  RICOCHET_PART_OF_CALLER static void total(const Sums& sums, double (&result)[d]) {
    for (int a = 0; a < d; ++a) result[a] = sums.of[a];
  }
};

/// Block of 2 × 2 in column-major order: one pack.
template <>
struct Block<2, false> {
  static constexpr Index numbers = 4;
  using Own = Pack<4>;
  struct Sums {
    Pack<4> of = {};
  };
  RICOCHET_PART_OF_CALLER static Own own(const double* x) { return Own{x[0], x[1], x[0], x[1]}; }
  RICOCHET_PART_OF_CALLER static void add(const double* block, const double* x, Sums& sums) {
    sums.of += load<4>(block) * Pack<4>{x[0], x[0], x[1], x[1]};
  }
  RICOCHET_PART_OF_CALLER static void add_transposed(const double* block, const Own& own, double* y) {
    const Pack<4> products = load<4>(block) * own;
    const Pack<2> first = __builtin_shufflevector(products, products, 0, 2);
    const Pack<2> second = __builtin_shufflevector(products, products, 1, 3);
    store<2>(y, load<2>(y) + (first + second));
  }
  RICOCHET_PART_OF_CALLER static void total(const Sums& sums, double (&result)[2]) {
    for (int a = 0; a < 2; ++a) result[a] = sums.of[a] + sums.of[a + 2];
  }
};

/// Block of 3 × 3 in column-major order: one pack per column, whose last number belongs to the following data and is
/// ignored.
template <>
struct Block<3, false> {
  static constexpr Index numbers = 9;
  using Own = Pack<4>;
  struct Sums {
    Pack<4> of[3] = {};
  };
  RICOCHET_PART_OF_CALLER static Own own(const double* x) { return Own{x[0], x[1], x[2], 0.0}; }
  RICOCHET_PART_OF_CALLER static void add(const double* block, const double* x, Sums& sums) {
    for (int c = 0; c < 3; ++c) sums.of[c] += load<4>(block + 3 * c) * x[c];
  }
  RICOCHET_PART_OF_CALLER static void add_transposed(const double* block, const Own& own, double* y) {
    const Pack<4> a = load<4>(block) * own, b = load<4>(block + 3) * own, c = load<4>(block + 6) * own;
    // Pairwise sums: first and second numbers of a and b, third ones of a and b; then those of c.
    const Pack<4> ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Pack<4> cc = c + __builtin_shufflevector(c, c, 1, 0, 3, 2);
    const Pack<2> lower = __builtin_shufflevector(ab, ab, 0, 1) + __builtin_shufflevector(ab, ab, 2, 3);
    store<2>(y, load<2>(y) + lower);
    y[2] += cc[0] + cc[2];
  }
  RICOCHET_PART_OF_CALLER static void total(const Sums& sums, double (&result)[3]) {
    for (int a = 0; a < 3; ++a) result[a] = (sums.of[0][a] + sums.of[1][a]) + sums.of[2][a];
  }
};

/// Prefetches the numbers of a part, since rows access them in an order that the processor cannot predict.
RICOCHET_PART_OF_CALLER void fetch(const double* begin, const double* end) {
  constexpr Index per_line = 8;
  for (const double* at = begin; at < end; at += per_line) __builtin_prefetch(at);
}

template <int d, bool scalar>
RICOCHET_PART_OF_CALLER void multiply_in(const NodeRows& rows, const double* __restrict x, double* __restrict y) {
  using Kind = Block<d, scalar>;
  fetch(x + rows.begin * d, x + rows.end * d);
  std::fill(y + rows.begin * d, y + rows.end * d, 0.0);
  for (const RowGroup& group : rows.groups) {
    const double* block = rows.values + group.first_block * Kind::numbers;
    const int* column = rows.column + group.first_block;
    for (Index row = group.first_row; row < group.end_row(); ++row) {
      const Index i = Index{rows.node[row]} * d;
      typename Kind::Sums sums;
      const typename Kind::Own own = Kind::own(x + i);
      for (Index k = 0; k < group.two_sided; ++k, block += Kind::numbers) {
        const Index other = Index{*column++} * d;
        __builtin_prefetch(block + fetch_blocks_ahead);
        Kind::add(block, x + other, sums);
        Kind::add_transposed(block, own, y + other);
      }
      for (Index k = 0; k < group.one_sided; ++k, block += Kind::numbers) {
        __builtin_prefetch(block + fetch_blocks_ahead);
        Kind::add(block, x + Index{*column++} * d, sums);
      }
      double total[d];
      Kind::total(sums, total);
      for (int a = 0; a < d; ++a) y[i + a] += total[a];
    }
  }
}

/// Quadratic form of rows of m ⊗ I with one number each, as in a diagonal matrix. Four sums are used, so that additions
/// need not wait for one another.
template <int d>
RICOCHET_PART_OF_CALLER double form_of_single_numbers(const NodeRows& rows, const RowGroup& group, const double* x) {
  double sums[4] = {};
  const Index begin = group.first_row, to_block = group.first_block - begin;
  const auto of_row = [&](Index row) {
    const double* const own = x + Index{rows.node[row]} * d;
    const double* const other = x + Index{rows.column[row + to_block]} * d;
    double product = 0.0;
    for (int a = 0; a < d; ++a) product += own[a] * other[a];
    return rows.values[row + to_block] * product;
  };
  Index row = begin;
  for (; row + 4 <= group.end_row(); row += 4) {
    for (int k = 0; k < 4; ++k) sums[k] += of_row(row + k);
  }
  for (; row < group.end_row(); ++row) sums[0] += of_row(row);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

template <int d, bool scalar>
RICOCHET_PART_OF_CALLER double form_in(const NodeRows& rows, const double* x) {
  using Kind = Block<d, scalar>;
  fetch(x + rows.begin * d, x + rows.end * d);
  double result = 0.0;
  for (const RowGroup& group : rows.groups) {
    if constexpr (scalar) {
      if (group.two_sided == 0 && group.one_sided == 1) {
        result += form_of_single_numbers<d>(rows, group, x);
        continue;
      }
    }
    const double* block = rows.values + group.first_block * Kind::numbers;
    const int* column = rows.column + group.first_block;
    for (Index row = group.first_row; row < group.end_row(); ++row) {
      typename Kind::Sums two_sided, one_sided;
      for (Index k = 0; k < group.two_sided; ++k, block += Kind::numbers) {
        __builtin_prefetch(block + fetch_blocks_ahead);
        Kind::add(block, x + Index{*column++} * d, two_sided);
      }
      for (Index k = 0; k < group.one_sided; ++k, block += Kind::numbers) {
        __builtin_prefetch(block + fetch_blocks_ahead);
        Kind::add(block, x + Index{*column++} * d, one_sided);
      }
      double both[d], one[d];
      Kind::total(two_sided, both);
      Kind::total(one_sided, one);
      const double* own = x + Index{rows.node[row]} * d;
      double sum = 0.0;
      for (int a = 0; a < d; ++a) sum += own[a] * (2.0 * both[a] + one[a]);
      result += sum;
    }
  }
  return result;
}

RICOCHET_EACH_INSTRUCTION_SET(void, multiply_blocks_2, (const NodeRows& rows, const double* x, double* y),
                              (rows, x, y)) {
  multiply_in<2, false>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET(void, multiply_blocks_3, (const NodeRows& rows, const double* x, double* y),
                              (rows, x, y)) {
  multiply_in<3, false>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET(void, multiply_scalars_2, (const NodeRows& rows, const double* x, double* y),
                              (rows, x, y)) {
  multiply_in<2, true>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET(void, multiply_scalars_3, (const NodeRows& rows, const double* x, double* y),
                              (rows, x, y)) {
  multiply_in<3, true>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET(double, form_blocks_2, (const NodeRows& rows, const double* x), (rows, x)) {
  return form_in<2, false>(rows, x);
}
RICOCHET_EACH_INSTRUCTION_SET(double, form_blocks_3, (const NodeRows& rows, const double* x), (rows, x)) {
  return form_in<3, false>(rows, x);
}
RICOCHET_EACH_INSTRUCTION_SET(double, form_scalars_2, (const NodeRows& rows, const double* x), (rows, x)) {
  return form_in<2, true>(rows, x);
}
RICOCHET_EACH_INSTRUCTION_SET(double, form_scalars_3, (const NodeRows& rows, const double* x), (rows, x)) {
  return form_in<3, true>(rows, x);
}

}  // namespace

void multiply_rows(const NodeRows& rows, int d, bool scalar, const double* x, double* y) {
  if (scalar) {
    d == 2 ? multiply_scalars_2(rows, x, y) : multiply_scalars_3(rows, x, y);
  } else {
    d == 2 ? multiply_blocks_2(rows, x, y) : multiply_blocks_3(rows, x, y);
  }
}

double form_rows(const NodeRows& rows, int d, bool scalar, const double* x) {
  if (scalar) return d == 2 ? form_scalars_2(rows, x) : form_scalars_3(rows, x);
  return d == 2 ? form_blocks_2(rows, x) : form_blocks_3(rows, x);
}

}  // namespace ricochet
