#include "ricochet/linear_algebra/sparse_matrix.hpp"

#include <algorithm>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

SparseMatrix extract(const SparseMatrix& matrix, const std::vector<int>& row_number, Index rows,
                     const std::vector<int>& column_number, Index columns) {
  SparseMatrix result(rows, columns);
  if (columns == 0) return result;  // Eigen's makeCompressed accesses a first column without checking that it exists
  std::vector<int> counts(static_cast<std::size_t>(columns), 0);
  for (Index j = 0; j < matrix.cols(); ++j) {
    const int column = column_number[std::size_t(j)];
    if (column < 0) continue;
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      counts[std::size_t(column)] += row_number[std::size_t(entry.row())] >= 0 ? 1 : 0;
    }
  }
  result.reserve(counts);
  for (Index j = 0; j < matrix.cols(); ++j) {
    const int column = column_number[std::size_t(j)];
    if (column < 0) continue;
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      const int row = row_number[std::size_t(entry.row())];
      if (row >= 0) result.insert(row, column) = entry.value();
    }
  }
  result.makeCompressed();
  return result;
}

namespace {

/// Calls enter(row, value) for the entries of a column of a + b, ascending.
template <class Enter>
void merge_column(const SparseMatrix& a, const SparseMatrix& b, Index column, const Enter& enter) {
  SparseMatrix::InnerIterator left(a, column), right(b, column);
  while (left || right) {
    if (!right || (left && left.row() < right.row())) {
      enter(left.row(), left.value());
      ++left;
    } else if (!left || right.row() < left.row()) {
      enter(right.row(), right.value());
      ++right;
    } else {
      enter(left.row(), left.value() + right.value());
      ++left;
      ++right;
    }
  }
}

}  // namespace

SparseMatrix add_sparse(const SparseMatrix& a, const SparseMatrix& b) {
  SparseMatrix result(a.rows(), a.cols());
  int* begins = result.outerIndexPtr();
  parallel_ranges(a.cols(), [&](Index first, Index last) {
    for (Index column = first; column < last; ++column) {
      int count = 0;
      merge_column(a, b, column, [&](Index, double) { ++count; });
      begins[column + 1] = count;
    }
  });
  for (Index column = 0; column < a.cols(); ++column) begins[column + 1] += begins[column];
  result.resizeNonZeros(begins[a.cols()]);
  parallel_ranges(a.cols(), [&](Index first, Index last) {
    for (Index column = first; column < last; ++column) {
      int at = begins[column];
      merge_column(a, b, column, [&](Index row, double value) {
        result.innerIndexPtr()[at] = int(row);
        result.valuePtr()[at++] = value;
      });
    }
  });
  return result;
}

SparseMatrix zeros_without(const SparseMatrix& pattern, const std::vector<char>& left_out) {
  SparseMatrix result(pattern.rows(), pattern.cols());
  const auto is_out = [&](Index i) { return left_out[std::size_t(i)] != 0; };
  int* const outer = result.outerIndexPtr();
  for (int pass = 0; pass < 2; ++pass) {
    int position = 0;
    for (Index column = 0; column < pattern.cols(); ++column) {
      outer[column] = position;
      if (is_out(column)) continue;
      for (SparseMatrix::InnerIterator entry(pattern, column); entry; ++entry) {
        if (is_out(entry.row())) continue;
        if (pass > 0) {
          result.innerIndexPtr()[position] = int(entry.row());
          result.valuePtr()[position] = 0.0;
        }
        ++position;
      }
    }
    outer[pattern.cols()] = position;
    if (pass == 0) result.resizeNonZeros(position);
  }
  return result;
}

double* stored_entry(SparseMatrix& matrix, Index row, Index column) {
  const int* const begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
  const int* const end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  const int* const at = std::lower_bound(begin, end, int(row));
  return at != end && *at == row ? matrix.valuePtr() + (at - matrix.innerIndexPtr()) : nullptr;
}

}  // namespace ricochet
