#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Compressed columns: parts and sums.
namespace ricochet {

/// The rows and columns of a matrix whose number is not negative, renumbered by it.
[[nodiscard]] SparseMatrix extract(const SparseMatrix& matrix, const std::vector<int>& row_number, Index rows,
                                   const std::vector<int>& column_number, Index columns);

/// a + b, of matrices of the same size. Memory for the sum is all that it takes, and its entries are those of either
/// (Eigen's operator takes three times as much).
[[nodiscard]] SparseMatrix add_sparse(const SparseMatrix& a, const SparseMatrix& b);

/// Zeros in the pattern of a square matrix, less the rows and columns that are left out. Takes the memory of the
/// result.
[[nodiscard]] SparseMatrix zeros_without(const SparseMatrix& pattern, const std::vector<char>& left_out);

/// Where an entry is stored; null where it is not. Searches the column.
[[nodiscard]] double* stored_entry(SparseMatrix& matrix, Index row, Index column);

}  // namespace ricochet
