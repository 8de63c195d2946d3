#include "ricochet/case/quantity.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
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

const std::array<std::pair<std::string, Quantity::Kind>, 4> functions{
    {{"max", Quantity::Kind::maximum},
     {"min", Quantity::Kind::minimum},
     {"max_abs", Quantity::Kind::maximum_absolute},
     {"total_variation", Quantity::Kind::total_variation}}};

[[noreturn]] void refuse(const std::string& text, const std::string& reason) {
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("\"{}\" is not a quantity: {}; write history.COLUMN[i], max(history.COLUMN), "
                  "min(history.COLUMN), max_abs(history.COLUMN), total_variation(history.COLUMN) or summary.PATH",
                  text, reason));
}

// Plain names joined by single dots.
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
  if (!is_dotted_name(name)) {
    refuse(text, name.empty() ? fmt::format("nothing stands after {}", prefix)
                              : fmt::format("\"{}\" is not made of letters, digits, _ and - joined by dots", name));
  }
  return std::string(name);
}

Quantity parse_function(const std::string& text, std::size_t opening) {
  const std::string name = text.substr(0, opening);
  std::vector<std::string> known;
  for (const auto& [function, kind] : functions) {
    known.push_back(function);
    if (function != name) continue;
    if (text.back() != ')') refuse(text, "the closing parenthesis is missing");
    const std::string body = text.substr(opening + 1, text.size() - opening - 2);
    if (body.find('[') != std::string::npos) refuse(text, "a function takes the whole column, without [i]");
    return {kind, dotted_name(text, history_prefix, body), 0};
  }
  const std::string near = nearest_name(name, known);
  refuse(text, fmt::format("unknown function \"{}\"{}", name,
                           near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near)));
}

Quantity parse_history_value(const std::string& text) {
  const std::size_t opening = text.find('[');
  if (opening == std::string::npos) refuse(text, "which row is not said: add [i], as in [-1] for the last one");
  if (text.back() != ']') refuse(text, "it does not end with ]");
  const std::string column = dotted_name(text, history_prefix, text.substr(0, opening));
  const std::string row_text = text.substr(opening + 1, text.size() - opening - 2);
  long row = 0;
  const auto [end, problem] = std::from_chars(row_text.data(), row_text.data() + row_text.size(), row);
  if (problem != std::errc() || end != row_text.data() + row_text.size()) {
    refuse(text, fmt::format("the row \"{}\" is not an integer", row_text));
  }
  return {Quantity::Kind::history_value, column, row};
}

}  // namespace

Quantity parse_quantity(const std::string& text) {
  if (const std::size_t opening = text.find('('); opening != std::string::npos) return parse_function(text, opening);
  if (text.starts_with(summary_prefix)) {
    return {Quantity::Kind::summary_value, dotted_name(text, summary_prefix, text), 0};
  }
  if (text.starts_with(history_prefix)) return parse_history_value(text);
  refuse(text, "it begins neither with history. nor with summary. nor with a function");
}

}  // namespace ricochet
