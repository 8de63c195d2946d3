#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/io/history_file.hpp"
#include "ricochet/report/packed_array.hpp"

/// @file A history in a page: all rows, or so many that it fits.
namespace ricochet {

struct HistoryPart {
  PackedArray table;  ///< columns × rows
  /// Of how many rows each pair of rows stands for the least and the largest value, in the order in which they come;
  /// 0: all rows are there.
  Index rows_per_pair = 0;
};

/// The thinned columns keep every extremum: a bump that one row shows is still there.
[[nodiscard]] HistoryPart pack_history(const HistoryTable& history, std::size_t most_bytes, PackedArrays& arrays);

/// Two values for each `rows` rows of a column: the least and the largest, in the order in which they come. Of what
/// rises, like the time, these are the first and the last.
[[nodiscard]] std::vector<double> thinned(const std::vector<double>& column, std::size_t rows);

}  // namespace ricochet
