#pragma once

#include <span>

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_pattern.hpp"

/// @file The loops of NodeMatrix over the rows of one part. Not part of the public interface.
namespace ricochet {

/// Rows of one part of a NodeMatrix, see there.
struct NodeRows {
  Index begin = 0, end = 0;  ///< nodes of the part
  std::span<const RowGroup> groups;
  const int* node = nullptr;  ///< of the rows, of all parts
  const int* column = nullptr;
  const double* values = nullptr;  ///< and one number after the last block
};

/// y = A x on these rows, and what their two-sided blocks add to other rows of the range. `scalar`: A = m ⊗ I.
void multiply_rows(const NodeRows& rows, int d, bool scalar, const double* x, double* y);
/// Σ over these rows i of x_iᵀ (2 Σ two-sided A_ij x_j + Σ one-sided A_ij x_j).
[[nodiscard]] double form_rows(const NodeRows& rows, int d, bool scalar, const double* x);

}  // namespace ricochet
