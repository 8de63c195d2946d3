#include <algorithm>

#include "ricochet/base/packs.hpp"
#include "ricochet/linear_algebra/node_kernels.hpp"

namespace ricochet {

namespace {

/// Prefetch distance in the stream of blocks, in numbers.
constexpr Index fetch_ahead = 1280;

typedef float Floats __attribute__((vector_size(16)));
typedef float UnalignedFloats __attribute__((vector_size(16), aligned(4)));
typedef float TwoFloats __attribute__((vector_size(8), aligned(4)));

RICOCHET_PART_OF_CALLER Floats load_floats(const float* from) {
  return *reinterpret_cast<const UnalignedFloats*>(from);
}
RICOCHET_PART_OF_CALLER void add_two(float* to, const Floats& value) {
  *reinterpret_cast<TwoFloats*>(to) += __builtin_shufflevector(value, value, 0, 1);
}

/// Block of 2 × 2; see node_kernels.cpp for the reasons.
template <int d>
struct SingleBlock {
  struct Sums {
    Floats of = {};
  };
  RICOCHET_PART_OF_CALLER static Floats own(const float* x) { return Floats{x[0], x[1], x[0], x[1]}; }
  RICOCHET_PART_OF_CALLER static void add(const float* block, const float* x, Sums& sums) {
    sums.of += load_floats(block) * Floats{x[0], x[0], x[1], x[1]};
  }
  RICOCHET_PART_OF_CALLER static void add_transposed(const float* block, const Floats& own, float* y) {
    const Floats products = load_floats(block) * own;
    add_two(y, __builtin_shufflevector(products, products, 0, 2, 0, 2) +
                   __builtin_shufflevector(products, products, 1, 3, 1, 3));
  }
  RICOCHET_PART_OF_CALLER static void add_total(const Sums& sums, float* y) {
    add_two(y, sums.of + __builtin_shufflevector(sums.of, sums.of, 2, 3, 2, 3));
  }
};
template <>
struct SingleBlock<3> {
  struct Sums {
    Floats of[3] = {};
  };
  RICOCHET_PART_OF_CALLER static Floats own(const float* x) { return Floats{x[0], x[1], x[2], 0.0F}; }
  RICOCHET_PART_OF_CALLER static void add(const float* block, const float* x, Sums& sums) {
    for (int c = 0; c < 3; ++c) sums.of[c] += load_floats(block + 3 * c) * x[c];
  }
  RICOCHET_PART_OF_CALLER static void add_transposed(const float* block, const Floats& own, float* y) {
    const Floats a = load_floats(block) * own, b = load_floats(block + 3) * own, c = load_floats(block + 6) * own;
    const Floats ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Floats cc = c + __builtin_shufflevector(c, c, 1, 0, 3, 2);
    add_two(y, ab + __builtin_shufflevector(ab, ab, 2, 3, 2, 3));
    y[2] += cc[0] + cc[2];
  }
  RICOCHET_PART_OF_CALLER static void add_total(const Sums& sums, float* y) {
    const Floats total = (sums.of[0] + sums.of[1]) + sums.of[2];
    add_two(y, total);
    y[2] += total[2];
  }
};

/// Returns xᵀ y in a fixed order: eight sums per stretch in single precision, and sums of stretches in double
/// precision.
RICOCHET_PART_OF_CALLER double single_dot(const float* x, const float* y, Index count) {
  constexpr Index stretch = 512;
  double total = 0.0;
  for (Index begin = 0; begin < count; begin += stretch) {
    const Index end = std::min(count, begin + stretch);
    Floats sums[2] = {};
    Index i = begin;
    for (; i + 8 <= end; i += 8) {
      for (int k = 0; k < 2; ++k) sums[k] += load_floats(x + i + 4 * k) * load_floats(y + i + 4 * k);
    }
    for (; i < end; ++i) sums[0][0] += x[i] * y[i];
    const Floats both = sums[0] + sums[1];
    total += double((both[0] + both[1]) + (both[2] + both[3]));
  }
  return total;
}

template <int d>
RICOCHET_PART_OF_CALLER double multiply_single_in(const NodeRowsOf<float>& rows, const float* __restrict x,
                                                  float* __restrict y) {
  constexpr Index numbers = d * d;
  std::fill(y + rows.begin * d, y + rows.end * d, 0.0F);
  for (const RowGroup& group : rows.groups) {
    const float* block = rows.values + group.first_block * numbers;
    const int* column = rows.column + group.first_block;
    for (Index row = group.first_row; row < group.end_row(); ++row) {
      const Index i = Index{rows.node[row]} * d;
      typename SingleBlock<d>::Sums sums;
      const Floats own = SingleBlock<d>::own(x + i);
      for (Index k = 0; k < group.two_sided; ++k, block += numbers) {
        const Index other = Index{*column++} * d;
        __builtin_prefetch(block + fetch_ahead);
        SingleBlock<d>::add(block, x + other, sums);
        SingleBlock<d>::add_transposed(block, own, y + other);
      }
      for (Index k = 0; k < group.one_sided; ++k, block += numbers) {
        __builtin_prefetch(block + fetch_ahead);
        SingleBlock<d>::add(block, x + Index{*column++} * d, sums);
      }
      SingleBlock<d>::add_total(sums, y + i);
    }
  }
  return single_dot(x + rows.begin * d, y + rows.begin * d, (rows.end - rows.begin) * d);
}

RICOCHET_EACH_INSTRUCTION_SET(double, multiply_single_2, (const NodeRowsOf<float>& rows, const float* x, float* y),
                              (rows, x, y)) {
  return multiply_single_in<2>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET(double, multiply_single_3, (const NodeRowsOf<float>& rows, const float* x, float* y),
                              (rows, x, y)) {
  return multiply_single_in<3>(rows, x, y);
}

}  // namespace

double multiply_single_rows(const NodeRowsOf<float>& rows, int d, const float* x, float* y) {
  return d == 2 ? multiply_single_2(rows, x, y) : multiply_single_3(rows, x, y);
}

}  // namespace ricochet
