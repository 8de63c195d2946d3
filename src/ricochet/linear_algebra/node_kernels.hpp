#pragma once

#include <span>

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/node_pattern.hpp"

/// @file Loops of NodeMatrix over the rows of one part. Not part of the public interface.
namespace ricochet {

/// Rows of one part of a NodeMatrix, see there.
template <class Number>
struct NodeRowsOf {
  Index begin = 0, end = 0;  ///< nodes of the part
  std::span<const RowGroup> groups;
  const int* node = nullptr;  ///< node of each row, over all parts
  const int* column = nullptr;
  const Number* values = nullptr;  ///< followed by one more number after the last block
};
using NodeRows = NodeRowsOf<double>;

/// Returns the rows of a part; `values` holds the blocks of all parts.
template <class Number>
[[nodiscard]] NodeRowsOf<Number> part_rows(const NodePattern& pattern, Index part, const Number* values) {
  const auto at = std::size_t(part);
  return {pattern.part_begins[at],
          pattern.part_begins[at + 1],
          {pattern.groups.data() + pattern.part_groups[at], pattern.groups.data() + pattern.part_groups[at + 1]},
          pattern.node.data(),
          pattern.column.data(),
          values};
}

/// Computes y = A x on these rows and adds the products of their two-sided blocks to other rows of the range. `scalar`:
/// A = m ⊗ I.
void multiply_rows(const NodeRows& rows, int d, bool scalar, const double* x, double* y);
/// Returns Σ over these rows i of x_iᵀ (2 Σ two-sided A_ij x_j + Σ one-sided A_ij x_j).
[[nodiscard]] double form_rows(const NodeRows& rows, int d, bool scalar, const double* x);

/// Computes y = A x on these rows as above, in single precision; returns xᵀ y over the nodes of the part.
[[nodiscard]] double multiply_single_rows(const NodeRowsOf<float>& rows, int d, const float* x, float* y);

}  // namespace ricochet
