#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/run_case.hpp"

namespace ricochet {

namespace {

std::string no_column(const std::string& name, const std::vector<std::string>& names) {
  const std::string near = nearest_name(name, names);
  return fmt::format("history.csv has no column \"{}\"{}", name,
                     near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near));
}

const std::vector<double>& column_of(const HistoryTable& history, const std::string& name) {
  const auto found = history.columns.find(name);
  if (found != history.columns.end() && !found->second.empty()) return found->second;
  throw Error(ErrorKind::invalid_input, no_column(name, history.names));
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

double evaluate(const Quantity& quantity, const HistoryTable& history, const std::string& summary_json) {
  if (quantity.kind == Quantity::Kind::summary_value) return summary_value(summary_json, quantity.name);
  const std::vector<double>& column = column_of(history, quantity.name);
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

/// Why an expectation does not apply to this run, or "".
std::string reason_not_to_check(const Case& input, const ExpectSection& expect) {
  for (const auto& [key, wanted] : expect.when) {
    const auto found = input.values.find(key);
    if (found == input.values.end() || found->second != wanted) return fmt::format("only for {} = {}", key, wanted);
  }
  for (const std::string& key : input.overridden) {
    if (!expect.when.contains(key) && !key.starts_with("output.fields"))
      return fmt::format("--set {} changed the case", key);
  }
  return "";
}

std::string wanted_in_words(const ExpectSection& expect) {
  if (expect.minimum || expect.maximum) {
    std::string text;
    if (expect.minimum) text = fmt::format("≥ {:g}", *expect.minimum);
    if (expect.maximum) text += fmt::format("{}≤ {:g}", text.empty() ? "" : " and ", *expect.maximum);
    return text;
  }
  std::string text = fmt::format("{:.9g}", expect.value);
  if (expect.relative) text += fmt::format(" within {:g} relative", *expect.relative);
  if (expect.absolute) text += fmt::format(" within {:g} absolute", *expect.absolute);
  return text;
}

bool holds(const ExpectSection& expect, double value) {
  if (!std::isfinite(value)) return false;
  if (expect.minimum || expect.maximum) {
    return (!expect.minimum || value >= *expect.minimum) && (!expect.maximum || value <= *expect.maximum);
  }
  const double tolerance =
      std::max(expect.absolute.value_or(0.0), expect.relative.value_or(0.0) * std::abs(expect.value));
  return std::abs(value - expect.value) <= tolerance;
}

}  // namespace

void check_expected_columns(const Case& input, const Model& model) {
  const std::vector<std::string> columns =
      names_of(HistoryRecorder::columns_of(model.problem.dimension, model.sensors));
  Problems problems;
  for (std::size_t i = 0; i < input.expectations.size(); ++i) {
    const ExpectSection& expect = input.expectations[i];
    const Quantity quantity = parse_quantity(expect.quantity);
    if (quantity.kind == Quantity::Kind::summary_value || !reason_not_to_check(input, expect).empty()) continue;
    if (std::find(columns.begin(), columns.end(), quantity.name) == columns.end())
      problems.add(input.where(fmt::format("expect.{}.quantity", i)), no_column(quantity.name, columns));
  }
  problems.raise();
}

std::vector<ExpectationResult> check_expectations(const Case& input, const std::string& output_directory,
                                                  const std::string& summary_json) {
  std::vector<ExpectationResult> results;
  if (input.expectations.empty()) return results;
  const HistoryTable history = read_history(output_directory + "/history.csv");
  for (std::size_t i = 0; i < input.expectations.size(); ++i) {
    const ExpectSection& expect = input.expectations[i];
    ExpectationResult result{
        expect.quantity, 0.0, wanted_in_words(expect), input.where(fmt::format("expect.{}", i)).text(), true, true, ""};
    result.note = reason_not_to_check(input, expect);
    result.checked = result.note.empty();
    if (result.checked) {
      try {
        result.value = evaluate(parse_quantity(expect.quantity), history, summary_json);
        result.holds = holds(expect, result.value);
      } catch (const Error& problem) {
        result.holds = false;
        result.note = problem.what();
      }
    }
    results.push_back(result);
  }
  return results;
}

}  // namespace ricochet
