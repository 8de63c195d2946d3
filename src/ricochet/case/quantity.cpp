#include "ricochet/case/quantity.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/keys.hpp"

namespace ricochet {

namespace {

constexpr std::string_view history_prefix = "history.";
constexpr std::string_view summary_prefix = "summary.";

const std::array<std::pair<std::string, Quantity::Kind>, 8> functions{
    {{"max", Quantity::Kind::maximum},
     {"min", Quantity::Kind::minimum},
     {"max_abs", Quantity::Kind::maximum_absolute},
     {"total_variation", Quantity::Kind::total_variation},
     {"mean", Quantity::Kind::mean},
     {"integral", Quantity::Kind::integral},
     {"first_time", Quantity::Kind::first_time},
     {"last_time", Quantity::Kind::last_time}}};

const std::array<QuantityForm, 12> forms{
    {{"history.COLUMN[i]",
      "the value in row i of history.csv; row 0 is the initial state, −1 the last row, −2 the one before. Refer to "
      "other rows by their time, as their numbers depend on the step"},
     {"history.COLUMN(t=T)", "the value at the time T of the run, interpolated linearly between the rows"},
     {"max(history.COLUMN)", "the largest value of all rows"},
     {"min(history.COLUMN)", "the smallest value of all rows"},
     {"max_abs(history.COLUMN)", "the largest absolute value of all rows"},
     {"total_variation(history.COLUMN)", "the sum of the absolute differences of consecutive rows"},
     {"mean(history.COLUMN)",
      "the mean over time, with values interpolated linearly between the rows (trapezoidal rule)"},
     {"integral(history.COLUMN)", "the integral over time, computed in the same way"},
     {"first_time(history.COLUMN > X)",
      "the first time at which the value is above X, or with `<` below X: that of a row, or where the line between two "
      "rows crosses X. If there is no such time, the expectation does not hold"},
     {"last_time(history.COLUMN > X)", "the last such time; that of the last row if the condition still holds there"},
     {"FUNCTION(history.COLUMN, T0, T1)",
      "each of these functions restricted to the time interval from T0 to T1, such as `max(history.COLUMN, T0, T1)` or "
      "`first_time(history.COLUMN > X, T0, T1)`: evaluated from the rows in it and the values at its ends, which are "
      "interpolated linearly between rows"},
     {"summary.PATH",
      "a number in summary.json by its dotted path; entries of lists are counted from 0: "
      "`summary.impacts.0.velocity_after.2` is the third component of the velocity after the first impact"}}};

[[noreturn]] void refuse(const std::string& text, const std::string& reason) {
  std::vector<std::string> names;
  for (const QuantityForm& form : forms) names.push_back(form.form);
  throw Error(ErrorKind::invalid_input,
              fmt::format("\"{}\" is not a quantity: {}; write {}", text, reason, join_names(names, " or ", false)));
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

// Splits at commas.
std::vector<std::string_view> between_commas(std::string_view text) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t comma = text.find(',');
    parts.push_back(without_blanks(text.substr(0, comma)));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

// Tests for plain names joined by single dots.
bool is_dotted_name(std::string_view name) {
  while (true) {
    const std::size_t dot = name.find('.');
    if (!is_plain_name(name.substr(0, dot))) return false;
    if (dot == std::string_view::npos) return true;
    name.remove_prefix(dot + 1);
  }
}

std::string dotted_name(const std::string& text, std::string_view prefix, std::string_view body) {
  if (!body.starts_with(prefix)) refuse(text, fmt::format("\"{}\" does not begin with {}", body, prefix));
  const std::string_view name = body.substr(prefix.size());
  if (const std::string dotted = with_dotted_numbers(body); prefix == summary_prefix && dotted != body)
    refuse(text, fmt::format("the number of an entry follows a dot, as in {}", dotted));
  if (!is_dotted_name(name)) {
    refuse(text, name.empty()
                     ? fmt::format("nothing follows {}", prefix)
                     : fmt::format("\"{}\" does not consist of letters, digits, _ and - joined by dots", name));
  }
  return std::string(name);
}

double read_number(const std::string& text, std::string_view what, std::string_view digits) {
  const std::optional<double> value = number_in(digits);
  if (!value) refuse(text, fmt::format("the {} \"{}\" is not a number", what, digits));
  return *value;
}

Quantity::Kind function_kind(const std::string& text, const std::string& name) {
  std::vector<std::string> function_names;
  for (const auto& [function, kind] : functions) {
    if (function == name) return kind;
    function_names.push_back(function);
  }
  const std::string near = nearest_name(name, function_names);
  refuse(text, fmt::format("unknown function \"{}\"{}", name,
                           near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near)));
}

TimeInterval read_interval(const std::string& text, const std::vector<std::string_view>& arguments) {
  if (arguments.size() != 3) refuse(text, "a time interval has two ends, T0 and T1, which follow the column");
  const TimeInterval interval{read_number(text, "time", arguments[1]), read_number(text, "time", arguments[2])};
  if (interval.begin >= interval.end)
    refuse(text, fmt::format("the interval from {} to {} does not end after it begins", arguments[1], arguments[2]));
  return interval;
}

// Reads COLUMN > X and removes the comparison from `condition`.
Threshold read_threshold(const std::string& text, const std::string& function, std::string_view& condition) {
  const std::size_t sign = condition.find_first_of("<>");
  if (sign == std::string_view::npos)
    refuse(text, fmt::format("{} requires a comparison of the column with a number: {}(history.COLUMN > X)", function,
                             function));
  const bool above = condition[sign] == '>';
  const std::string_view level = without_blanks(condition.substr(sign + 1));
  if (level.starts_with('='))
    refuse(text, fmt::format("{}= is not supported: write {}", condition[sign], condition[sign]));
  condition = without_blanks(condition.substr(0, sign));
  return {read_number(text, "level", level), above};
}

Quantity parse_function(const std::string& text, std::size_t opening) {
  const std::string function = text.substr(0, opening);
  Quantity quantity{.kind = function_kind(text, function)};
  if (text.back() != ')') refuse(text, "the closing parenthesis is missing");
  const std::string body = text.substr(opening + 1, text.size() - opening - 2);
  if (body.find('[') != std::string::npos) refuse(text, "a function applies to the whole column, without [i]");
  if (body.find('(') != std::string::npos)
    refuse(text, "a function applies to a column, not to a value at a time or another function");
  const std::vector<std::string_view> arguments = between_commas(body);
  std::string_view column = arguments[0];
  if (quantity.kind == Quantity::Kind::first_time || quantity.kind == Quantity::Kind::last_time) {
    quantity.threshold = read_threshold(text, function, column);
  } else if (column.find_first_of("<>") != std::string_view::npos) {
    refuse(text, fmt::format("only first_time and last_time accept a comparison, {} does not", function));
  }
  quantity.name = dotted_name(text, history_prefix, column);
  if (arguments.size() > 1) quantity.interval = read_interval(text, arguments);
  return quantity;
}

Quantity parse_value_at_time(const std::string& text, std::size_t opening) {
  if (text.back() != ')') refuse(text, "it does not end with )");
  const std::string body = text.substr(opening + 1, text.size() - opening - 2);
  const std::size_t equals = body.find('=');
  if (equals == std::string::npos || without_blanks(std::string_view(body).substr(0, equals)) != "t")
    refuse(text, "the parentheses must contain a time, as in (t=0.5)");
  return {.kind = Quantity::Kind::value_at_time,
          .name = dotted_name(text, history_prefix, text.substr(0, opening)),
          .time = read_number(text, "time", without_blanks(std::string_view(body).substr(equals + 1)))};
}

Quantity parse_history_value(const std::string& text) {
  const std::size_t opening = text.find_first_of("[(");
  if (opening == std::string::npos)
    refuse(text, "the row is missing: add [i], as in [-1] for the last row, or a time, as in (t=0.5)");
  if (text[opening] == '(') return parse_value_at_time(text, opening);
  if (text.back() != ']') refuse(text, "it does not end with ]");
  const std::string column = dotted_name(text, history_prefix, text.substr(0, opening));
  const std::string row_text = text.substr(opening + 1, text.size() - opening - 2);
  long row = 0;
  const auto [end, problem] = std::from_chars(row_text.data(), row_text.data() + row_text.size(), row);
  if (problem != std::errc() || end != row_text.data() + row_text.size()) {
    refuse(text, fmt::format("the row \"{}\" is not an integer", row_text));
  }
  return {.kind = Quantity::Kind::history_value, .name = column, .row = row};
}

}  // namespace

std::span<const QuantityForm> quantity_forms() { return forms; }

Quantity parse_quantity(const std::string& text) {
  if (text.starts_with(history_prefix)) return parse_history_value(text);
  if (text.starts_with(summary_prefix))
    return {.kind = Quantity::Kind::summary_value, .name = dotted_name(text, summary_prefix, text)};
  if (const std::size_t opening = text.find('('); opening != std::string::npos) return parse_function(text, opening);
  const std::string begin = text.substr(0, text.find_first_of(".["));
  if (find_section(begin) != nullptr)
    refuse(text, fmt::format("\"{}\" is a key of the case, which a study varies with --vary and a run sets with --set",
                             with_dotted_numbers(text)));
  refuse(text, "it begins with neither history. nor summary. nor a function");
}

}  // namespace ricochet
