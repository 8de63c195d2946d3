#pragma once

#include <optional>
#include <span>
#include <string>

/// @file Quantities that an [[expect]] may refer to.
namespace ricochet {

/// Notation of a quantity, for messages and the reference of the case file.
struct QuantityForm {
  std::string form;
  std::string meaning;
};

/// All notations:
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
  bool above = true;  ///< otherwise below
};

/// Parsed number of the results.
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
  std::string name = {};                      ///< column or dotted path
  long row = 0;                               ///< for history_value
  double time = 0.0;                          ///< for value_at_time
  Threshold threshold = {};                   ///< for first_time and last_time
  std::optional<TimeInterval> interval = {};  ///< for functions; null: the whole history
};

/// Throws Error(invalid_input), which names the error and lists the notations.
[[nodiscard]] Quantity parse_quantity(const std::string& text);

}  // namespace ricochet
