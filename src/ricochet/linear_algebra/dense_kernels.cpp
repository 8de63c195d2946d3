#include "ricochet/linear_algebra/dense_kernels.hpp"

#include <cmath>

#include "ricochet/base/instruction_sets.hpp"

namespace ricochet {

namespace {

RICOCHET_EACH_INSTRUCTION_SET(void, add_one, (Index size, const float* __restrict a, double f, double* __restrict y),
                              (size, a, f, y)) {
  for (Index i = 0; i < size; ++i) y[i] += f * double(a[i]);
}

RICOCHET_EACH_INSTRUCTION_SET(void, add_two,
                              (Index size, const float* __restrict a, const float* __restrict b, double f, double g,
                               double* __restrict y),
                              (size, a, b, f, g, y)) {
  for (Index i = 0; i < size; ++i) y[i] = (y[i] + f * double(a[i])) + g * double(b[i]);
}

RICOCHET_EACH_INSTRUCTION_SET(void, add_three,
                              (Index size, const float* __restrict a, const float* __restrict b,
                               const float* __restrict c, double f, double g, double h, double* __restrict y),
                              (size, a, b, c, f, g, h, y)) {
  for (Index i = 0; i < size; ++i) {
    y[i] = ((y[i] + f * double(a[i])) + g * double(b[i])) + h * double(c[i]);
  }
}

RICOCHET_EACH_INSTRUCTION_SET(void, add_one, (Index size, const double* __restrict a, double f, double* __restrict y),
                              (size, a, f, y)) {
  for (Index i = 0; i < size; ++i) y[i] += f * a[i];
}

RICOCHET_EACH_INSTRUCTION_SET(void, add_two,
                              (Index size, const double* __restrict a, const double* __restrict b, double f, double g,
                               double* __restrict y),
                              (size, a, b, f, g, y)) {
  for (Index i = 0; i < size; ++i) y[i] = (y[i] + f * a[i]) + g * b[i];
}

RICOCHET_EACH_INSTRUCTION_SET(void, add_three,
                              (Index size, const double* __restrict a, const double* __restrict b,
                               const double* __restrict c, double f, double g, double h, double* __restrict y),
                              (size, a, b, c, f, g, h, y)) {
  for (Index i = 0; i < size; ++i) y[i] = ((y[i] + f * a[i]) + g * b[i]) + h * c[i];
}

RICOCHET_EACH_INSTRUCTION_SET(void, add_one_with_size,
                              (Index size, const double* __restrict a, double f, double* __restrict y,
                               double* __restrict sizes),
                              (size, a, f, y, sizes)) {
  for (Index i = 0; i < size; ++i) {
    const double term = f * a[i];
    y[i] += term;
    sizes[i] += std::abs(term);
  }
}

RICOCHET_EACH_INSTRUCTION_SET(void, add_two_with_size,
                              (Index size, const double* __restrict a, const double* __restrict b, double f, double g,
                               double* __restrict y, double* __restrict sizes),
                              (size, a, b, f, g, y, sizes)) {
  for (Index i = 0; i < size; ++i) {
    const double first = f * a[i], second = g * b[i];
    y[i] = (y[i] + first) + second;
    sizes[i] += std::abs(first) + std::abs(second);
  }
}

RICOCHET_EACH_INSTRUCTION_SET(void, add_three_with_size,
                              (Index size, const double* __restrict a, const double* __restrict b,
                               const double* __restrict c, double f, double g, double h, double* __restrict y,
                               double* __restrict sizes),
                              (size, a, b, c, f, g, h, y, sizes)) {
  for (Index i = 0; i < size; ++i) {
    const double first = f * a[i], second = g * b[i], third = h * c[i];
    y[i] = ((y[i] + first) + second) + third;
    sizes[i] += std::abs(first) + std::abs(second) + std::abs(third);
  }
}

template <typename Number>
void add_any(Index size, Index count, const Number* columns, Index stride, const double* factors, double* y) {
  if (count == 3) {
    add_three(size, columns, columns + stride, columns + 2 * stride, factors[0], factors[1], factors[2], y);
  } else if (count == 2) {
    add_two(size, columns, columns + stride, factors[0], factors[1], y);
  } else {
    add_one(size, columns, factors[0], y);
  }
}

}  // namespace

void add_columns(Index size, Index count, const double* columns, Index stride, const double* factors, double* y) {
  add_any(size, count, columns, stride, factors, y);
}

void add_columns(Index size, Index count, const float* columns, Index stride, const double* factors, double* y) {
  add_any(size, count, columns, stride, factors, y);
}

void add_columns(Index size, Index count, const double* columns, Index stride, const double* factors, double* y,
                 double* sizes) {
  if (count == 3) {
    add_three_with_size(size, columns, columns + stride, columns + 2 * stride, factors[0], factors[1], factors[2], y,
                        sizes);
  } else if (count == 2) {
    add_two_with_size(size, columns, columns + stride, factors[0], factors[1], y, sizes);
  } else {
    add_one_with_size(size, columns, factors[0], y, sizes);
  }
}

}  // namespace ricochet
