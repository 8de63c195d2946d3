#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/quantity_value.hpp"
#include "ricochet/run/run_case.hpp"

namespace ricochet {

namespace {

/// Returns the reason why an expectation does not apply to this run, or "".
std::string reason_not_to_check(const Case& input, const ExpectSection& expect, ExpectationScope scope) {
  for (const auto& [key, required] : expect.when) {
    const auto found = input.values.find(key);
    if (found == input.values.end() || found->second != required) return fmt::format("only for {} = {}", key, required);
  }
  if (scope == ExpectationScope::any_settings) return "";
  for (const std::string& key : input.overridden) {
    if (!expect.when.contains(key) && !key.starts_with("output.fields"))
      return fmt::format("--set {} changed the case", key);
  }
  return "";
}

std::string expected_text(const ExpectSection& expect) {
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

/// Returns the quantity with its factor and divisor.
std::string quantity_in_words(const ExpectSection& expect) {
  return (expect.times == 1.0 ? "" : fmt::format("{:g} * ", expect.times)) + expect.quantity +
         (expect.over.empty() ? "" : " / " + expect.over);
}

double tolerance_of(const ExpectSection& expect) {
  return std::max(expect.absolute.value_or(0.0), expect.relative.value_or(0.0) * std::abs(expect.value));
}

bool holds(const ExpectSection& expect, double value) {
  if (!std::isfinite(value)) return false;
  if (expect.minimum || expect.maximum) {
    return (!expect.minimum || value >= *expect.minimum) && (!expect.maximum || value <= *expect.maximum);
  }
  return std::abs(value - expect.value) <= tolerance_of(expect);
}

double found_value(const ExpectSection& expect, const HistoryTable& history, const std::string& summary_json) {
  const double value = expect.times * value_of(parse_quantity(expect.quantity), history, summary_json);
  if (expect.over.empty()) return value;
  const double divisor = value_of(parse_quantity(expect.over), history, summary_json);
  if (divisor == 0.0) throw Error(ErrorKind::invalid_input, fmt::format("{} is 0: cannot divide by it", expect.over));
  return value / divisor;
}

ExpectationResult described(const ExpectSection& expect) {
  ExpectationResult result{
      .name = expect.name,
      .quantity = quantity_in_words(expect),
      .published = expect.published,
      .expected = expected_text(expect),
      .minimum = expect.minimum,
      .maximum = expect.maximum,
  };
  if (!expect.minimum && !expect.maximum) {
    result.expected_value = expect.value;
    result.tolerance = tolerance_of(expect);
  }
  return result;
}

/// Returns the reason why a quantity cannot be evaluated in a run of this case, or "".
std::string problem_of(const Case& input, const Quantity& quantity, const std::vector<std::string>& columns) {
  const std::string problem = impossible_in(input.time, quantity), column = required_column(quantity);
  if (!problem.empty() || column.empty() || std::ranges::count(columns, column) > 0) return problem;
  return no_such_column(input, column, columns);
}

}  // namespace

void check_expected_quantities(const Case& input, const Model& model) {
  const std::vector<std::string> columns = names_of(history_columns(model));
  Problems problems;
  for (std::size_t i = 0; i < input.expectations.size(); ++i) {
    const ExpectSection& expect = input.expectations[i];
    if (!reason_not_to_check(input, expect, ExpectationScope::settings_of_the_case).empty()) continue;
    const auto check = [&](const std::string& key, const std::string& text) {
      const std::string problem = problem_of(input, parse_quantity(text), columns);
      if (!problem.empty()) problems.add(input.where(fmt::format("expect.{}.{}", i, key)), problem);
    };
    check("quantity", expect.quantity);
    if (!expect.over.empty()) check("over", expect.over);
  }
  problems.raise();
}

std::vector<ExpectationResult> check_expectations(const Case& input, const std::string& output_directory,
                                                  const std::string& summary_json, ExpectationScope scope) {
  std::vector<ExpectationResult> results;
  if (input.expectations.empty()) return results;
  const HistoryTable history = read_history(output_directory + "/history.csv");
  for (std::size_t i = 0; i < input.expectations.size(); ++i) {
    const ExpectSection& expect = input.expectations[i];
    ExpectationResult result = described(expect);
    result.location = input.where(fmt::format("expect.{}", i)).text();
    result.note = reason_not_to_check(input, expect, scope);
    result.checked = result.note.empty();
    if (result.checked) {
      try {
        result.value = found_value(expect, history, summary_json);
        result.holds = holds(expect, result.value);
      } catch (const Error& problem) {
        result.holds = false;
        result.note = problem.what();
        result.location = input.where(fmt::format("expect.{}.quantity", i)).text();
      }
    }
    results.push_back(result);
  }
  return results;
}

std::vector<ExpectationResult> unmet_expectations(const Case& input, const std::string& why, ExpectationScope scope) {
  std::vector<ExpectationResult> results;
  for (std::size_t i = 0; i < input.expectations.size(); ++i) {
    ExpectationResult result = described(input.expectations[i]);
    result.location = input.where(fmt::format("expect.{}", i)).text();
    result.note = reason_not_to_check(input, input.expectations[i], scope);
    result.checked = result.note.empty();
    result.holds = !result.checked;
    if (result.checked) result.note = why;
    results.push_back(result);
  }
  return results;
}

}  // namespace ricochet
