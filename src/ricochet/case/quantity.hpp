#pragma once

#include <optional>
#include <span>
#include <string>

/// @file The quantities an [[expect]] may be about.
namespace ricochet {

/// One way to write a quantity, for messages and the reference of the case file.
struct QuantityForm {
  std::string form;
  std::string meaning;
};

/// All of them:
///   history.COLUMN[i]            the value in row i of history.csv; negative i count from the last row, −1
///   history.COLUMN(t=T)          the value at a time, linear between the rows
///   FUNCTION(history.COLUMN)     over all rows: max, min, max_abs, total_variation, mean, integral
///   EVENT(history.COLUMN > X)    a time: first_time or last_time at which the value is above X, with < below it
///   …, T0, T1)                   a function or an event of the interval from T0 to T1 alone
///   summary.PATH                 a number of summary.json, by its dotted path
[[nodiscard]] std::span<const QuantityForm> quantity_forms();

struct TimeInterval {
  double begin = 0.0, end = 0.0;
};

struct Threshold {
  double level = 0.0;
  bool above = true;  ///< or below
};

/// A number of the results, taken apart.
struct Quantity {
  enum class Kind {
    history_value,
    value_at_time,
    maximum,
    minimum,
    maximum_absolute,
    total_variation,
    mean,
    integral,
    first_time,
    last_time,
    summary_value
  };
  Kind kind = Kind::history_value;
  std::string name = {};                      ///< the column, or the dotted path
  long row = 0;                               ///< of history_value
  double time = 0.0;                          ///< of value_at_time
  Threshold threshold = {};                   ///< of first_time and last_time
  std::optional<TimeInterval> interval = {};  ///< of functions; none: the whole history
};

/// Throws Error(invalid_input) that says what is wrong and lists the forms there are.
[[nodiscard]] Quantity parse_quantity(const std::string& text);

}  // namespace ricochet
