#pragma once

#include "ricochet/base/types.hpp"

/// @file Loops over columns of a dense matrix that memory bandwidth limits, compiled for several instruction sets.
namespace ricochet {

/// y += Σ_k factor_k · column_k with up to three neighbouring columns of length `size`, `stride` apart. Each entry of y
/// is the same whatever the size: no sum is split.
void add_columns(Index size, Index count, const double* columns, Index stride, const double* factors, double* y);
/// The same with columns in single precision: half the memory to read.
void add_columns(Index size, Index count, const float* columns, Index stride, const double* factors, double* y);
/// The same and, into `sizes`, the sum of the absolute values of the terms.
void add_columns(Index size, Index count, const double* columns, Index stride, const double* factors, double* y,
                 double* sizes);

}  // namespace ricochet
