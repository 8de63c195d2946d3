#include "ricochet/linear_algebra/node_kernels.hpp"

#include <algorithm>

#include "ricochet/base/instruction_sets.hpp"

namespace ricochet {

namespace {

constexpr int block_size(int d, bool scalar) {
  return scalar ? 1 : d * d;
}

/// How far ahead of the blocks to fetch, in numbers: from memory a product is a quarter to a third quicker for it.
constexpr Index fetch_ahead = 512;

/// sums(·, c) += A(·, c) x_c for the columns c of a block: their sum is taken at the end, so that additions need not
/// wait for one another. For m ⊗ I there is one column of sums.
template <int d, bool scalar>
RICOCHET_PART_OF_CALLER void add_block(const double* block, const double* x, double (&sums)[scalar ? 1 : d][d]) {
  if constexpr (scalar) {
    for (int a = 0; a < d; ++a) sums[0][a] += block[0] * x[a];
  } else {
    for (int c = 0; c < d; ++c) {
      for (int a = 0; a < d; ++a) sums[c][a] += block[c * d + a] * x[c];
    }
  }
}

template <int d, bool scalar>
RICOCHET_PART_OF_CALLER void add_transposed_block(const double* block, const double* x, double* y) {
  if constexpr (scalar) {
    for (int a = 0; a < d; ++a) y[a] += block[0] * x[a];
  } else {
    for (int c = 0; c < d; ++c) {
      double sum = block[c * d] * x[0];
      for (int a = 1; a < d; ++a) sum += block[c * d + a] * x[a];
      y[c] += sum;
    }
  }
}

template <int d, int columns>
RICOCHET_PART_OF_CALLER double component(const double (&sums)[columns][d], int a) {
  double total = sums[0][a];
  for (int c = 1; c < columns; ++c) total += sums[c][a];
  return total;
}

template <int d, bool scalar>
RICOCHET_PART_OF_CALLER void multiply_in(const NodeRows& rows, const double* __restrict x, double* __restrict y) {
  constexpr int stride = block_size(d, scalar);
  std::fill(y + rows.begin * d, y + rows.end * d, 0.0);
  for (Index i = rows.begin; i < rows.end; ++i) {
    double sums[scalar ? 1 : d][d] = {};
    double own[d];
    for (int a = 0; a < d; ++a) own[a] = x[i * d + a];
    Index k = rows.row_begin[i];
    for (const Index end = rows.one_sided[i]; k < end; ++k) {
      const Index other = Index{rows.column[k]} * d;
      __builtin_prefetch(rows.values + k * stride + fetch_ahead);
      add_block<d, scalar>(rows.values + k * stride, x + other, sums);
      add_transposed_block<d, scalar>(rows.values + k * stride, own, y + other);
    }
    for (const Index end = rows.row_begin[i + 1]; k < end; ++k) {
      __builtin_prefetch(rows.values + k * stride + fetch_ahead);
      add_block<d, scalar>(rows.values + k * stride, x + Index{rows.column[k]} * d, sums);
    }
    for (int a = 0; a < d; ++a) y[i * d + a] += component(sums, a);
  }
}

template <int d, bool scalar>
RICOCHET_PART_OF_CALLER double form_in(const NodeRows& rows, const double* x) {
  constexpr int stride = block_size(d, scalar);
  double result = 0.0;
  for (Index i = rows.begin; i < rows.end; ++i) {
    double two_sided[scalar ? 1 : d][d] = {}, one_sided[scalar ? 1 : d][d] = {};
    Index k = rows.row_begin[i];
    for (const Index end = rows.one_sided[i]; k < end; ++k) {
      __builtin_prefetch(rows.values + k * stride + fetch_ahead);
      add_block<d, scalar>(rows.values + k * stride, x + Index{rows.column[k]} * d, two_sided);
    }
    for (const Index end = rows.row_begin[i + 1]; k < end; ++k) {
      __builtin_prefetch(rows.values + k * stride + fetch_ahead);
      add_block<d, scalar>(rows.values + k * stride, x + Index{rows.column[k]} * d, one_sided);
    }
    double row = 0.0;
    for (int a = 0; a < d; ++a) row += x[i * d + a] * (2.0 * component(two_sided, a) + component(one_sided, a));
    result += row;
  }
  return result;
}

RICOCHET_EACH_INSTRUCTION_SET
void multiply_blocks_2(const NodeRows& rows, const double* x, double* y) {
  multiply_in<2, false>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET
void multiply_blocks_3(const NodeRows& rows, const double* x, double* y) {
  multiply_in<3, false>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET
void multiply_scalars_2(const NodeRows& rows, const double* x, double* y) {
  multiply_in<2, true>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET
void multiply_scalars_3(const NodeRows& rows, const double* x, double* y) {
  multiply_in<3, true>(rows, x, y);
}
RICOCHET_EACH_INSTRUCTION_SET
double form_blocks_2(const NodeRows& rows, const double* x) {
  return form_in<2, false>(rows, x);
}
RICOCHET_EACH_INSTRUCTION_SET
double form_blocks_3(const NodeRows& rows, const double* x) {
  return form_in<3, false>(rows, x);
}
RICOCHET_EACH_INSTRUCTION_SET
double form_scalars_2(const NodeRows& rows, const double* x) {
  return form_in<2, true>(rows, x);
}
RICOCHET_EACH_INSTRUCTION_SET
double form_scalars_3(const NodeRows& rows, const double* x) {
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
