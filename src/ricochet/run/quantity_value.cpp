#include "ricochet/run/quantity_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/summary.hpp"

namespace ricochet {

std::string no_column_message(const std::string& name, const std::vector<std::string>& names) {
  const std::string near = nearest_name(name, names);
  return fmt::format("history.csv has no column \"{}\"{}", name,
                     near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near));
}

namespace {

const std::vector<double>& values_of(const HistoryTable& history, const std::string& name) {
  const auto found = history.columns.find(name);
  if (found != history.columns.end() && !found->second.empty()) return found->second;
  throw Error(ErrorKind::invalid_input, no_column_message(name, history.names));
}

double value_in_row(const std::vector<double>& column, const Quantity& quantity) {
  const long rows = static_cast<long>(column.size());
  const long row = quantity.row < 0 ? rows + quantity.row : quantity.row;
  if (row < 0 || row >= rows) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("history.{}[{}]: history.csv has {}", quantity.name, quantity.row, counted(rows, "row")));
  }
  return column[static_cast<std::size_t>(row)];
}

}  // namespace

double evaluate(const Quantity& quantity, const HistoryTable& history, const std::string& summary_json) {
  if (quantity.kind == Quantity::Kind::summary_value) return summary_value(summary_json, quantity.name);
  const std::vector<double>& column = values_of(history, quantity.name);
  double result = 0.0;
  switch (quantity.kind) {
    case Quantity::Kind::history_value:
      return value_in_row(column, quantity);
    case Quantity::Kind::maximum:
      return *std::max_element(column.begin(), column.end());
    case Quantity::Kind::minimum:
      return *std::min_element(column.begin(), column.end());
    case Quantity::Kind::maximum_absolute:
      for (const double value : column) result = std::max(result, std::abs(value));
      return result;
    case Quantity::Kind::total_variation:
      for (std::size_t i = 1; i < column.size(); ++i) result += std::abs(column[i] - column[i - 1]);
      return result;
    case Quantity::Kind::summary_value:
      break;
  }
  return result;
}

}  // namespace ricochet
