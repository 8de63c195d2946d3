#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/quantity_value.hpp"
#include "ricochet/run/run_case.hpp"

namespace ricochet {

namespace {

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
      problems.add(input.where(fmt::format("expect.{}.quantity", i)), no_column_message(quantity.name, columns));
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
