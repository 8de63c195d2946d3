#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Parts and sums of matrices in compressed columns.
namespace ricochet {

/// Returns the rows and columns with a number that is not negative, renumbered by it.
[[nodiscard]] SparseMatrix extract(const SparseMatrix& matrix, const std::vector<int>& row_number, Index rows,
                                   const std::vector<int>& column_number, Index columns);

/// Returns a + b for matrices of the same size, with the union of their patterns. Needs no memory beyond the sum
/// (Eigen's operator needs three times as much).
[[nodiscard]] SparseMatrix add_sparse(const SparseMatrix& a, const SparseMatrix& b);

/// Returns zeros in the pattern of a square matrix without the rows and columns `left_out`. Needs no memory beyond the
/// result.
[[nodiscard]] SparseMatrix zeros_without(const SparseMatrix& pattern, const std::vector<char>& left_out);

/// Returns a pointer to a stored entry; null if it is not stored. Searches the column.
[[nodiscard]] double* stored_entry(SparseMatrix& matrix, Index row, Index column);

}  // namespace ricochet
