#pragma once

#include <string>
#include <vector>

#include "ricochet/case/quantity.hpp"
#include "ricochet/io/history_file.hpp"

/// @file The value that a quantity has in a run.
namespace ricochet {

/// Throws Error(invalid_input) where the run has no such column, row or entry.
[[nodiscard]] double evaluate(const Quantity& quantity, const HistoryTable& history, const std::string& summary_json);

/// "history.csv has no column ...", with the one that was probably meant.
[[nodiscard]] std::string no_column_message(const std::string& name, const std::vector<std::string>& names);

}  // namespace ricochet
