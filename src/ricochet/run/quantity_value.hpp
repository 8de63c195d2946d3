#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/io/history_file.hpp"

/// @file Values of quantities in the results of a run.
namespace ricochet {

/// Returns the value of a quantity. Between the rows of a history each column is interpolated linearly in time; a time
/// within a millionth of the distance of two rows from one of them means that row. Throws Error(invalid_input) if there
/// is no such column, row or entry, a time lies outside the rows, or an event never occurs.
[[nodiscard]] double value_of(const Quantity& quantity, const HistoryTable& history, const std::string& summary_json);

/// Returns the reason why no run with these steps has a quantity, whatever its columns: an entry that summary.json does
/// not have, a time outside the run or a row beyond the last; "" if it may have it.
[[nodiscard]] std::string impossible_in(const TimeSection& time, const Quantity& quantity);

/// Returns the column of history.csv from which a quantity follows, also that of summary.extrema.COLUMN.…; "" if none.
[[nodiscard]] std::string required_column(const Quantity& quantity);

/// Returns the message that history.csv has no column of this name, with the one that may be meant.
[[nodiscard]] std::string no_such_column(const std::string& name, const std::vector<std::string>& names);

/// Returns the same message for runs of a case; columns of a probe with "every" are in a file of their own.
[[nodiscard]] std::string no_such_column(const Case& input, const std::string& name,
                                         const std::vector<std::string>& names);

}  // namespace ricochet
