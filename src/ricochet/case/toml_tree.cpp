#include "ricochet/case/toml_tree.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <tuple>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/keys.hpp"

namespace ricochet {

namespace {

SourceLocation location_of(const toml::source_region& region, const std::string& file) {
  return {file, int(region.begin.line), int(region.begin.column)};
}

bool stands_before(const TomlNode& a, const TomlNode& b) {
  return std::tie(a.key_location.line, a.key_location.column) < std::tie(b.key_location.line, b.key_location.column);
}

TomlNode convert(const toml::node& source, const std::string& file);

void convert_table(const toml::table& table, const std::string& file, TomlNode& node) {
  node.kind = TomlNode::Kind::table;
  for (const auto& [key, member] : table) {
    TomlNode& child = node.children.emplace_back(convert(member, file));
    child.key = std::string(key.str());
    child.key_location = location_of(key.source(), file);
  }
  // toml++ sorts members by name; users of messages and results expect the order of the file.
  std::ranges::stable_sort(node.children, stands_before);
}

void convert_list(const toml::array& list, const std::string& file, TomlNode& node) {
  node.kind = TomlNode::Kind::list;
  for (const toml::node& entry : list) {
    TomlNode& child = node.children.emplace_back(convert(entry, file));
    child.key_location = child.location;
  }
}

TomlNode convert(const toml::node& source, const std::string& file) {
  TomlNode node;
  node.location = location_of(source.source(), file);
  if (const auto* table = source.as_table()) {
    convert_table(*table, file, node);
  } else if (const auto* list = source.as_array()) {
    convert_list(*list, file, node);
  } else if (const auto* text = source.as_string()) {
    node.kind = TomlNode::Kind::text;
    node.text = text->get();
  } else if (const auto* integer = source.as_integer()) {
    node.kind = TomlNode::Kind::integer;
    node.integer = integer->get();
  } else if (const auto* real = source.as_floating_point()) {
    node.kind = TomlNode::Kind::real;
    node.real = real->get();
  } else if (const auto* boolean = source.as_boolean()) {
    node.kind = TomlNode::Kind::boolean;
    node.boolean = boolean->get();
  } else {
    node.kind = TomlNode::Kind::date;
  }
  return node;
}

void set_location(TomlNode& node, const SourceLocation& location) {
  node.location = location;
  node.key_location = location;
  for (TomlNode& child : node.children) set_location(child, location);
}

// Writes a decimal point, so that 1.0 is not read as the integer 1.
std::string real_text(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
}

/// Values that the keys of a name accept in any section.
struct AcceptedValues {
  bool numbers = false, texts = false, any = false;
};

void add_accepted(const std::vector<Key>& keys, const std::string& name, AcceptedValues& accepted) {
  using enum KeyType;
  constexpr std::array of_numbers{number, integer, vector, numbers, axial, formula, formulas, axial_formulas};
  constexpr std::array of_texts{text, choice, formula, formulas, axial_formulas, components, names, groups};
  for (const Key& key : keys) {
    add_accepted(key.keys, name, accepted);
    if (key.name != name) continue;
    accepted.any = true;
    accepted.numbers = accepted.numbers || std::ranges::count(of_numbers, key.type) > 0;
    accepted.texts = accepted.texts || std::ranges::count(of_texts, key.type) > 0 || !key.choices.empty();
  }
}

/// Returns the name before an equals sign at this position, without the tables of a dotted key.
std::string name_before(const std::string& line, std::size_t equals) {
  constexpr const char* around = " \t\"'{,.";
  const std::size_t last = line.substr(0, equals).find_last_not_of(around);
  if (last == std::string::npos) return "";
  const std::size_t before = line.find_last_of(around, last);  // npos: the name begins the line
  return line.substr(before + 1, last - before);
}

/// Returns a hint if the value of a line is a text without quotes or a number with a unit, else "".
std::string missing_quotes_hint(const std::string& line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos) return "";
  const std::string value = line.substr(equals + 1, line.find('#', equals) - equals - 1);
  const std::size_t begin = value.find_first_not_of(" \t\r");
  if (begin == std::string::npos || value.find_first_of("\"'[{", begin) == begin) return "";
  if (value.find('=') != std::string::npos || parse_toml_value(value, {})) return "";
  AcceptedValues accepted;
  for (const Section& section : case_sections()) add_accepted(section.keys, name_before(line, equals), accepted);
  const std::string hint = unit_hint(value);
  if (!hint.empty() && !accepted.any) return "; units are not written, and texts need quotes";
  if (!hint.empty() && accepted.numbers) return hint;
  const bool is_text = !accepted.numbers || std::isalpha(static_cast<unsigned char>(value[begin])) != 0 ||
                       value.find_first_of("*/^(") != std::string::npos;
  return accepted.texts && is_text ? "; texts need quotes" : "";
}

/// Returns a hint if quotes are missing, or a number with a decimal comma or a unit is at a position of the document,
/// counted from 1; else "".
std::string value_hint(const std::string& document, const SourceLocation& location) {
  std::size_t begin = 0;
  for (int line = 1; line < location.line; ++line) {
    begin = document.find('\n', begin);
    if (begin == std::string::npos) return "";
    ++begin;
  }
  const std::string line = document.substr(begin, document.find('\n', begin) - begin);
  constexpr std::string_view digits = "0123456789";
  const auto comma = std::size_t(location.column) - 1;
  if (line.find('=') < comma) {
    if (std::string hint = missing_quotes_hint(line); !hint.empty()) return hint;
  }
  if (location.column < 2 || comma + 1 >= line.size() || line[comma] != ',') return "";
  if (digits.find(line[comma - 1]) == std::string_view::npos || digits.find(line[comma + 1]) == std::string_view::npos)
    return "";
  const std::size_t before = line.find_last_not_of(digits, comma - 1);
  const std::string whole = line.substr(before + 1, comma - before - 1);
  const std::string fraction = line.substr(comma + 1, line.find_first_not_of(digits, comma + 1) - comma - 1);
  return fmt::format("; use a decimal point: {}.{}", whole, fraction);
}

std::string children_text(const TomlNode& node) {
  std::string text;
  for (const TomlNode& child : node.children) {
    if (!text.empty()) text += ", ";
    text += node.is_table() ? fmt::format("\"{}\" = {}", child.key, value_text(child)) : value_text(child);
  }
  return text;
}

}  // namespace

bool TomlNode::is_list_of_tables() const {
  return kind == Kind::list && !children.empty() &&
         std::ranges::all_of(children, [](const TomlNode& child) { return child.is_table(); });
}

const TomlNode* TomlNode::find(std::string_view name) const {
  const auto named = [name](const TomlNode& child) { return child.key == name; };
  const auto found = std::ranges::find_if(children, named);
  return kind == Kind::table && found != children.end() ? &*found : nullptr;
}

TomlNode* TomlNode::find(std::string_view name) {
  return const_cast<TomlNode*>(static_cast<const TomlNode*>(this)->find(name));
}

std::string unit_hint(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos || text.find_first_of("+-.0123456789", begin) != begin) return "";
  char* end = nullptr;
  const double number = std::strtod(text.c_str() + begin, &end);
  const std::size_t unit = text.find_first_not_of(' ', std::size_t(end - text.c_str()));
  if (end == text.c_str() + begin || unit == std::string::npos) return "";
  if (text[unit] == '%') return fmt::format("; write {:.9g} % as {:.9g}", number, number / 100.0);
  constexpr std::array<std::string_view, 5> symbols{"µ", "μ", "°", "Ω", "Å"};  // the first is U+00B5, the second U+03BC
  const std::string_view rest = std::string_view(text).substr(unit);
  const auto begins_rest = [rest](std::string_view symbol) { return rest.starts_with(symbol); };
  if (std::isalpha(static_cast<unsigned char>(rest[0])) == 0 && std::ranges::none_of(symbols, begins_rest)) return "";
  return "; units are not written: give the number alone, in the units of the other values";
}

TomlNode parse_toml(const std::string& document, const std::string& file) {
  try {
    return convert(toml::parse(document), file);
  } catch (const toml::parse_error& problem) {
    const SourceLocation location = location_of(problem.source(), file);
    throw Error(ErrorKind::invalid_input, fmt::format("{}: invalid TOML: {}{}", location.text(), problem.description(),
                                                      value_hint(document, location)));
  }
}

std::optional<TomlNode> parse_toml_value(const std::string& text, const SourceLocation& location) {
  try {
    TomlNode document = convert(toml::parse("value = " + text), location.file);
    // A line break in the text could introduce more keys than the intended one.
    if (document.children.size() != 1) return std::nullopt;
    TomlNode value = document.children.front();
    set_location(value, location);
    return value;
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
}

std::string value_text(const TomlNode& node) {
  switch (node.kind) {
    case TomlNode::Kind::text:
      return node.text;
    case TomlNode::Kind::integer:
      return fmt::format("{}", node.integer);
    case TomlNode::Kind::real:
      return fmt::format("{}", node.real == 0.0 ? 0.0 : node.real);  // no "-0"
    case TomlNode::Kind::boolean:
      return node.boolean ? "true" : "false";
    case TomlNode::Kind::date:
      return "date";
    case TomlNode::Kind::list:
      return fmt::format("[{}]", children_text(node));
    case TomlNode::Kind::table:
      return fmt::format("{{{}}}", children_text(node));
  }
  return "";
}

std::string describe(const TomlNode& node) {
  switch (node.kind) {
    case TomlNode::Kind::text:
      return fmt::format("the text \"{}\"", node.text);
    case TomlNode::Kind::integer:
      return fmt::format("the integer {}", node.integer);
    case TomlNode::Kind::real:
      return fmt::format("the number {}", real_text(node.real));
    case TomlNode::Kind::boolean:
      return node.boolean ? "the boolean true" : "the boolean false";
    case TomlNode::Kind::date:
      return "a date or time";
    case TomlNode::Kind::table:
      return "a table";
    case TomlNode::Kind::list:
      break;
  }
  if (node.is_list_of_tables()) return "a list of tables";
  const std::size_t count = node.children.size();
  return count == 0 ? "an empty list" : fmt::format("a list of {}", counted(count, "value"));
}

}  // namespace ricochet
