#pragma once

#include <utility>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Rows of a sparse matrix that reach other columns than before.
namespace ricochet {

class RowWriter {
 public:
  using Entries = std::vector<std::pair<Index, double>>;

  /// Row `row` is to have these entries, ascending by columns.
  void set(Index row, const Entries& entries);
  /// Writes what has been set since the last time. Whether anything changed; `changed`: per row, is set to 1 where.
  bool write(SparseRowMatrix& matrix, std::vector<char>& changed);

 private:
  struct Row {
    Index number = 0;
    std::size_t begin = 0, end = 0;
  };
  [[nodiscard]] bool is_same(const SparseRowMatrix& matrix, const Row& row) const;

  std::vector<Row> rows_;
  Entries entries_;
  SparseRowMatrix next_;
};

}  // namespace ricochet
