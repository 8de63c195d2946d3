#pragma once

#include <utility>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Replacement of rows of a sparse matrix with a change of pattern.
namespace ricochet {

class RowWriter {
 public:
  using Entries = std::vector<std::pair<Index, double>>;

  /// Schedules the entries of a row, ascending by columns.
  void set(Index row, const Entries& entries);
  /// Writes all scheduled rows. Returns whether anything changed; sets `changed` to 1 for each changed row.
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
