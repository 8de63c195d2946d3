#pragma once

#include "ricochet/base/types.hpp"

/// @file Loops over columns of a dense matrix that memory bandwidth limits, compiled for several instruction sets.
namespace ricochet {

/// Computes y += Σ_k factor_k · column_k for up to three neighbouring columns of length `size`, `stride` apart. Each
/// entry of y has the same bits for any size: no sum is split.
void add_columns(Index size, Index count, const double* columns, Index stride, const double* factors, double* y);
/// Version for columns in single precision, which halves the memory traffic.
void add_columns(Index size, Index count, const float* columns, Index stride, const double* factors, double* y);
/// Version that also adds the absolute values of the terms to `sizes`.
void add_columns(Index size, Index count, const double* columns, Index stride, const double* factors, double* y,
                 double* sizes);

}  // namespace ricochet
