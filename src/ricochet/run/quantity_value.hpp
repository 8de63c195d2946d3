#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/io/history_file.hpp"

/// @file Values of quantities in the results of a run.
namespace ricochet {

/// The value of a quantity. Between the rows of a history each column is taken to be linear in time; a time within a
/// millionth of the distance of two rows of one of them is that row. Throws Error(invalid_input): there is no such
/// column, row or entry, a time lies outside the rows, an event never is.
[[nodiscard]] double value_of(const Quantity& quantity, const HistoryTable& history, const std::string& summary_json);

/// That history.csv has no column of this name, and which one may be meant.
[[nodiscard]] std::string no_such_column(const std::string& name, const std::vector<std::string>& names);

/// The same of runs of a case: columns of a probe with "every" are not there, but in a file of their own.
[[nodiscard]] std::string no_such_column(const Case& input, const std::string& name,
                                         const std::vector<std::string>& names);

}  // namespace ricochet
