#pragma once

#include <string>

/// @file The quantities an [[expect]] may be about.
namespace ricochet {

/// A number of the results, taken apart:
///   history.COLUMN[i]          the value in row i of history.csv; negative i count from the last row, −1
///   max(history.COLUMN), min(…), max_abs(…), total_variation(…)    over all rows
///   summary.PATH               a number of summary.json, by its dotted path
struct Quantity {
  enum class Kind { history_value, maximum, minimum, maximum_absolute, total_variation, summary_value };
  Kind kind = Kind::history_value;
  std::string name;  ///< the column, or the dotted path
  long row = 0;      ///< of history_value
};

/// Throws Error(invalid_input) that says what is wrong and lists the forms there are.
[[nodiscard]] Quantity parse_quantity(const std::string& text);

}  // namespace ricochet
