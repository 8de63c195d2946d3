#pragma once

#include <vector>

#include "ricochet/io/history_file.hpp"
#include "ricochet/report/packed_array.hpp"

/// @file A history in a page: all rows, or as many as fit.
namespace ricochet {

struct HistoryPart {
  PackedArray table;  ///< columns × rows
  /// Number of rows for which each pair of rows holds the smallest and the largest value, in the order of their
  /// occurrence; 0: all rows are included.
  Index rows_per_pair = 0;
};

/// Packs a history. Thinned columns keep every extremum, so that even a peak of one row remains visible.
[[nodiscard]] HistoryPart pack_history(const HistoryTable& history, std::size_t most_bytes, PackedArrays& arrays);

/// Returns two values for each `rows` rows of a column: the smallest and the largest, in the order of their occurrence.
/// For increasing values, such as times, these are the first and the last.
[[nodiscard]] std::vector<double> thinned(const std::vector<double>& column, std::size_t rows);

}  // namespace ricochet
