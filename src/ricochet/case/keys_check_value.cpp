#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>

#include "ricochet/base/text.hpp"
#include "ricochet/case/keys_check.hpp"

namespace ricochet {

namespace {

using Kind = TomlNode::Kind;

// Accepts integers as numbers and converts them, so that 1 and 1.0 have the same text.
bool make_finite_number(TomlNode& value) {
  if (value.kind == Kind::integer) {
    value.real = double(value.integer);
    value.kind = Kind::real;
  }
  return value.kind == Kind::real && std::isfinite(value.real);
}

bool is_choice(const std::string& word, const std::vector<std::string>& choices) {
  return std::ranges::find(choices, word) != choices.end();
}

/// Returns a word in lower case, without blanks and hyphens.
std::string bare_word(const std::string& word) {
  std::string bare;
  for (const char c : word) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) bare += char(std::tolower(static_cast<unsigned char>(c)));
  }
  return bare;
}

/// Returns the only choice that is a part of the word or contains it: "stress" for "plane stress", "neo-hookean" for
/// "neohooke", "hht-alpha" for "hht"; "" if there is none.
std::string overlapping_choice(const std::string& word, const std::vector<std::string>& choices) {
  constexpr std::size_t shortest = 4;
  const std::string bare = bare_word(word);
  std::string found;
  for (const std::string& choice : choices) {
    const std::string other = bare_word(choice);
    const std::size_t least = other.starts_with(bare) ? shortest - 1 : shortest;
    const bool overlap = bare.size() < other.size() ? bare.size() >= least && other.find(bare) != std::string::npos
                                                    : other.size() >= shortest && bare.find(other) != std::string::npos;
    if (!overlap) continue;
    if (!found.empty()) return "";
    found = choice;
  }
  return found;
}

// Returns `; did you mean "newmark"?` or nothing.
std::string suggestion(const TomlNode& value, const std::vector<std::string>& choices) {
  if (value.kind != Kind::text) return "";
  std::string near = nearest_name(value.text, choices);
  if (near.empty()) near = overlapping_choice(value.text, choices);
  return near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near);
}

/// Returns whether pairs of entries are the two parts of numbers with a decimal comma, between which there is no blank:
/// [1,5, -0,5] has four entries.
bool has_decimal_commas(const TomlNode& list) {
  const std::vector<TomlNode>& parts = list.children;
  if (parts.size() % 2 != 0) return false;
  bool is_any_certain = false;
  for (std::size_t i = 0; i < parts.size(); i += 2) {
    const TomlNode &whole = parts[i], &fraction = parts[i + 1];
    if (whole.kind != Kind::integer || fraction.kind != Kind::integer || fraction.integer < 0) return false;
    if (whole.location.line != fraction.location.line) return false;
    const auto digits = int(std::to_string(whole.integer).size());
    const int width = fraction.location.column - whole.location.column - 1;
    const bool may_be_minus_zero = whole.integer == 0 && width == digits + 1;  // or 0 and a blank
    if (width != digits && !may_be_minus_zero) return false;
    is_any_certain = is_any_certain || width == digits;
  }
  return is_any_certain;
}

/// Checks one value.
class ValueCheck {
 public:
  ValueCheck(const Key& key, TomlNode& value, Problems& problems) : key_(key), value_(value), problems_(problems) {}
  void run();

 private:
  void check_choice();
  void check_number();
  void check_integer();
  void check_vector(bool with_expressions);
  void check_numbers();
  void check_axial(bool allows_expressions);
  /// Requires distinct names that `is_name` accepts; otherwise one "must be" what `expected` says.
  void check_names(const std::function<bool(const std::string& name)>& is_name, const std::string& expected);
  void check_parameters();
  /// Refuses the value for a problem at the position of a part of it.
  void refuse(const SourceLocation& location, const std::string& message) {
    value_.is_refused = true;
    problems_.add(location, message);
  }
  void refuse_unless(bool good) {
    if (!good) refuse_as(admissible_with_unit(key_), describe(value_));
  }
  void refuse_as(const std::string& expected, const std::string& found, const std::string& more = "") {
    refuse(value_.location, fmt::format("\"{}\" must be {}; found {}{}", key_.name, expected, found, more));
  }

  const Key& key_;
  TomlNode& value_;
  Problems& problems_;
};

void ValueCheck::check_choice() {
  if (value_.kind == Kind::text && is_choice(value_.text, key_.choices)) return;
  std::string more = suggestion(value_, key_.choices);
  if (key_.decides && more.empty()) more = ". " + key_.doc;
  refuse_as(admissible_values(key_), describe(value_), more);
}

void ValueCheck::check_number() {
  const std::string found = describe(value_);
  if (make_finite_number(value_) && is_within(key_.range, value_.real)) return;
  const bool is_finite = value_.kind != Kind::real || std::isfinite(value_.real);
  refuse_as(admissible_with_unit(key_), found, is_finite ? unit_hint(value_.text) : ", which is not finite");
}

void ValueCheck::check_integer() {
  const bool is_valid =
      value_.kind == Kind::integer && (key_.choices.empty() ? is_within(key_.range, double(value_.integer))
                                                            : is_choice(std::to_string(value_.integer), key_.choices));
  if (!is_valid) refuse_as(admissible_with_unit(key_), describe(value_), unit_hint(value_.text));
}

// Checks the entries of a vector. Expressions are compiled later, when their parameters are known.
void ValueCheck::check_vector(bool with_expressions) {
  const bool is_vector = value_.kind == Kind::list && !value_.is_list_of_tables();
  if (!is_vector || (value_.children.size() != 2 && value_.children.size() != 3)) {
    const char* const commas = "; if their commas are decimal ones, use decimal points";
    return refuse_as(admissible_with_unit(key_), describe(value_),
                     !is_vector                   ? suggestion(value_, key_.choices)
                     : has_decimal_commas(value_) ? commas
                                                  : "");
  }
  for (std::size_t i = 0; i < value_.children.size(); ++i) {
    TomlNode& component = value_.children[i];
    if (make_finite_number(component) || (with_expressions && component.kind == Kind::text)) continue;
    refuse(component.location,
           fmt::format("entry {} of \"{}\" must be a finite number{}; found {}{}", i + 1, key_.name,
                       with_expressions ? " or an expression" : "", describe(component), unit_hint(component.text)));
  }
}

void ValueCheck::check_numbers() {
  if (value_.kind != Kind::list || value_.children.empty()) return refuse_unless(false);
  Key of_entry = key_;
  of_entry.type = KeyType::number;
  for (std::size_t i = 0; i < value_.children.size(); ++i) {
    TomlNode& entry = value_.children[i];
    const std::string found = describe(entry);
    if (make_finite_number(entry) && is_within(key_.range, entry.real)) continue;
    refuse(entry.location, fmt::format("entry {} of \"{}\" must be {}; found {}{}", i + 1, key_.name,
                                       admissible_with_unit(of_entry), found, unit_hint(entry.text)));
  }
}

void ValueCheck::check_axial(bool allows_expressions) {
  if (value_.kind == Kind::list && value_.children.size() == 3) return check_vector(allows_expressions);
  if (allows_expressions && value_.kind == Kind::text) return;
  if (value_.is_number() && make_finite_number(value_)) return;
  refuse_as(admissible_with_unit(key_), describe(value_), unit_hint(value_.text));
}

void ValueCheck::check_names(const std::function<bool(const std::string& name)>& is_name, const std::string& expected) {
  if (value_.kind != Kind::list || value_.children.empty()) return refuse_unless(false);
  std::vector<std::string> accepted;
  for (const TomlNode& name : value_.children) {
    std::string reason;
    if (name.kind != Kind::text || !is_name(name.text)) {
      reason = fmt::format("must be {}; found {}{}", expected, describe(name), suggestion(name, key_.choices));
    } else if (is_choice(name.text, accepted)) {
      reason = fmt::format("repeats \"{}\"", name.text);
    }
    accepted.push_back(name.text);
    if (!reason.empty()) refuse(name.location, fmt::format("an entry of \"{}\" {}", key_.name, reason));
  }
}

void ValueCheck::check_parameters() {
  if (!value_.is_table()) return refuse_unless(false);
  for (TomlNode& parameter : value_.children) {
    const std::string& name = parameter.key;
    const bool is_identifier =
        is_plain_name(name) && name.find('-') == std::string::npos && !(name[0] >= '0' && name[0] <= '9');
    if (!is_identifier || is_choice(name, {"x", "y", "z", "t", "pi"})) {
      refuse(parameter.key_location,
             fmt::format("\"{}\" cannot be the name of a parameter: {}", name,
                         is_identifier ? "x, y, z, t and pi are reserved"
                                       : "it must consist of letters, digits and _, and not begin with a digit"));
    } else if (!make_finite_number(parameter)) {
      refuse(parameter.location, fmt::format("the parameter \"{}\" must be a finite number; found {}{}", name,
                                             describe(parameter), unit_hint(parameter.text)));
    }
  }
}

void ValueCheck::run() {
  const bool is_text = value_.kind == Kind::text;
  switch (key_.type) {
    case KeyType::text:
      return refuse_unless(is_text && !(key_.required && value_.text.empty()));
    case KeyType::choice:
      return check_choice();
    case KeyType::number:
      if (!is_text || !is_choice(value_.text, key_.choices)) check_number();
      return;
    case KeyType::integer:
      return check_integer();
    case KeyType::flag:
      return refuse_unless(value_.kind == Kind::boolean);
    case KeyType::vector:
      return check_vector(false);
    case KeyType::numbers:
      return check_numbers();
    case KeyType::axial:
    case KeyType::axial_formulas:
      return check_axial(key_.type == KeyType::axial_formulas);
    case KeyType::formula:
      if (!is_text) check_number();
      return;
    case KeyType::formulas:
      if (!is_text || !is_choice(value_.text, key_.choices)) check_vector(true);
      return;
    case KeyType::components:
    case KeyType::names:
      return check_names([&](const std::string& name) { return is_choice(name, key_.choices); },
                         join_names(key_.choices, " or "));
    case KeyType::groups:
      if (is_text && !value_.text.empty()) return;
      return check_names([](const std::string& name) { return !name.empty(); }, "the name of a group");
    case KeyType::parameters:
      return check_parameters();
    case KeyType::conditions:
    case KeyType::table:  // their content is checked by check_tree, which has the whole document
      return refuse_unless(value_.is_table());
    case KeyType::tables:
      return refuse_unless(value_.is_table() || value_.is_list_of_tables());
  }
}

}  // namespace

void check_value(const Key& key, TomlNode& value, Problems& problems) { ValueCheck(key, value, problems).run(); }

}  // namespace ricochet
