#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "ricochet/base/text.hpp"
#include "ricochet/case/keys_check.hpp"

namespace ricochet {

namespace {

using Kind = TomlNode::Kind;

void refuse(TomlNode& value, const std::string& message, Problems& problems) {
  value.is_refused = true;
  problems.add(value.location, message);
}

void refuse_type(const Key& key, TomlNode& value, Problems& problems) {
  refuse(value, fmt::format("\"{}\" must be {}; found {}", key.name, admissible_with_unit(key), describe(value)),
         problems);
}

// Accepts integers as numbers and converts them, so that 1 and 1.0 have the same text.
bool make_finite_number(TomlNode& value) {
  if (value.kind == Kind::integer) {
    value.real = static_cast<double>(value.integer);
    value.kind = Kind::real;
  }
  return value.kind == Kind::real && std::isfinite(value.real);
}

bool is_choice(const std::string& word, const std::vector<std::string>& choices) {
  return std::find(choices.begin(), choices.end(), word) != choices.end();
}

/// Returns a word in lower case, without blanks and hyphens.
std::string bare_word(const std::string& word) {
  std::string bare;
  for (const char c : word) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      bare += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return bare;
}

/// Returns the only choice that is a part of the word or contains it: "stress" for "plane stress", "neo-hookean" for
/// "neohooke"; "" if there is none.
std::string overlapping_choice(const std::string& word, const std::vector<std::string>& choices) {
  constexpr std::size_t shortest = 4;
  const std::string bare = bare_word(word);
  std::string found;
  for (const std::string& choice : choices) {
    const std::string other = bare_word(choice);
    const bool overlap = bare.size() < other.size() ? bare.size() >= shortest && other.find(bare) != std::string::npos
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
    const auto digits = static_cast<int>(std::to_string(whole.integer).size());
    const int width = fraction.location.column - whole.location.column - 1;
    const bool may_be_minus_zero = whole.integer == 0 && width == digits + 1;  // or 0 and a blank
    if (width != digits && !may_be_minus_zero) return false;
    is_any_certain = is_any_certain || width == digits;
  }
  return is_any_certain;
}

void check_choice(const Key& key, TomlNode& value, Problems& problems) {
  if (value.kind == Kind::text && is_choice(value.text, key.choices)) return;
  std::string more = suggestion(value, key.choices);
  if (key.decides && more.empty()) more = ". " + key.doc;
  refuse(value, fmt::format("\"{}\" must be {}; found {}{}", key.name, admissible_values(key), describe(value), more),
         problems);
}

void check_number(const Key& key, TomlNode& value, Problems& problems) {
  const TomlNode found = value;
  if (make_finite_number(value) && is_within(key.range, value.real)) return;
  value.is_refused = true;
  const char* finite = found.kind == Kind::real && !std::isfinite(found.real) ? ", which is not finite" : "";
  problems.add(value.location, fmt::format("\"{}\" must be {}; found {}{}", key.name, admissible_with_unit(key),
                                           describe(found), finite));
}

void check_integer(const Key& key, TomlNode& value, Problems& problems) {
  const bool is_good =
      value.kind == Kind::integer && (key.choices.empty() ? is_within(key.range, static_cast<double>(value.integer))
                                                          : is_choice(std::to_string(value.integer), key.choices));
  if (!is_good) refuse_type(key, value, problems);
}

// Checks the entries of a vector. Expressions are compiled later, when their parameters are known.
void check_vector(const Key& key, TomlNode& value, bool with_expressions, Problems& problems) {
  const bool is_vector = value.kind == Kind::list && !value.is_list_of_tables();
  if (!is_vector) {
    refuse(value,
           fmt::format("\"{}\" must be {}; found {}{}", key.name, admissible_with_unit(key), describe(value),
                       suggestion(value, key.choices)),
           problems);
    return;
  }
  if (value.children.size() != 2 && value.children.size() != 3) {
    refuse(value,
           fmt::format("\"{}\" must be {}; found {}{}", key.name, admissible_with_unit(key), describe(value),
                       has_decimal_commas(value) ? "; if their commas are decimal ones, use decimal points" : ""),
           problems);
    return;
  }
  for (std::size_t i = 0; i < value.children.size(); ++i) {
    TomlNode& component = value.children[i];
    if (make_finite_number(component) || (with_expressions && component.kind == Kind::text)) continue;
    value.is_refused = true;
    problems.add(component.location,
                 fmt::format("entry {} of \"{}\" must be a finite number{}; found {}", i + 1, key.name,
                             with_expressions ? " or an expression" : "", describe(component)));
  }
}

void check_numbers(const Key& key, TomlNode& value, Problems& problems) {
  if (value.kind != Kind::list || value.children.empty()) return refuse_type(key, value, problems);
  Key of_entry = key;
  of_entry.type = KeyType::number;
  for (std::size_t i = 0; i < value.children.size(); ++i) {
    TomlNode& entry = value.children[i];
    const TomlNode found = entry;
    if (make_finite_number(entry) && is_within(key.range, entry.real)) continue;
    value.is_refused = true;
    problems.add(entry.location, fmt::format("entry {} of \"{}\" must be {}; found {}", i + 1, key.name,
                                             admissible_with_unit(of_entry), describe(found)));
  }
}

void check_axial(const Key& key, TomlNode& value, bool allows_expressions, Problems& problems) {
  if (value.kind == Kind::list && value.children.size() == 3)
    return check_vector(key, value, allows_expressions, problems);
  if (allows_expressions && value.kind == Kind::text) return;
  if (!value.is_number() || !make_finite_number(value)) refuse_type(key, value, problems);
}

void check_directions(const Key& key, TomlNode& value, Problems& problems) {
  if (value.kind != Kind::list || value.children.empty()) return refuse_type(key, value, problems);
  std::vector<std::string> accepted;
  for (const TomlNode& name : value.children) {
    std::string reason;
    if (name.kind != Kind::text || !is_choice(name.text, key.choices)) {
      reason = fmt::format("must be {}; found {}{}", join_names(key.choices, " or "), describe(name),
                           suggestion(name, key.choices));
    } else if (is_choice(name.text, accepted)) {
      reason = fmt::format("repeats \"{}\"", name.text);
    }
    accepted.push_back(name.text);
    if (reason.empty()) continue;
    value.is_refused = true;
    problems.add(name.location, fmt::format("an entry of \"{}\" {}", key.name, reason));
  }
}

void check_groups(const Key& key, TomlNode& value, Problems& problems) {
  if (value.kind == Kind::text && !value.text.empty()) return;
  if (value.kind != Kind::list || value.children.empty()) return refuse_type(key, value, problems);
  std::vector<std::string> accepted;
  for (const TomlNode& name : value.children) {
    std::string reason;
    if (name.kind != Kind::text || name.text.empty()) {
      reason = fmt::format("must be the name of a group; found {}", describe(name));
    } else if (is_choice(name.text, accepted)) {
      reason = fmt::format("repeats \"{}\"", name.text);
    }
    accepted.push_back(name.text);
    if (reason.empty()) continue;
    value.is_refused = true;
    problems.add(name.location, fmt::format("an entry of \"{}\" {}", key.name, reason));
  }
}

void check_parameters(const Key& key, TomlNode& value, Problems& problems) {
  if (!value.is_table()) return refuse_type(key, value, problems);
  for (TomlNode& parameter : value.children) {
    const std::string& name = parameter.key;
    const bool is_identifier =
        is_plain_name(name) && name.find('-') == std::string::npos && !(name[0] >= '0' && name[0] <= '9');
    if (!is_identifier || is_choice(name, {"x", "y", "z", "t", "pi"})) {
      value.is_refused = true;
      problems.add(parameter.key_location,
                   fmt::format("\"{}\" cannot be the name of a parameter: {}", name,
                               is_identifier ? "x, y, z, t and pi are reserved"
                                             : "it must consist of letters, digits and _, and not begin with a digit"));
    } else if (!make_finite_number(parameter)) {
      value.is_refused = true;
      problems.add(parameter.location,
                   fmt::format("the parameter \"{}\" must be a finite number; found {}", name, describe(parameter)));
    }
  }
}

}  // namespace

void check_value(const Key& key, TomlNode& value, Problems& problems) {
  switch (key.type) {
    case KeyType::text:
      if (value.kind != Kind::text || (key.required && value.text.empty())) refuse_type(key, value, problems);
      return;
    case KeyType::choice:
      return check_choice(key, value, problems);
    case KeyType::number:
      if (value.kind == Kind::text && is_choice(value.text, key.choices)) return;
      return check_number(key, value, problems);
    case KeyType::integer:
      return check_integer(key, value, problems);
    case KeyType::flag:
      if (value.kind != Kind::boolean) refuse_type(key, value, problems);
      return;
    case KeyType::vector:
      return check_vector(key, value, false, problems);
    case KeyType::numbers:
      return check_numbers(key, value, problems);
    case KeyType::axial:
      return check_axial(key, value, false, problems);
    case KeyType::axial_formulas:
      return check_axial(key, value, true, problems);
    case KeyType::formula:
      if (value.kind != Kind::text) check_number(key, value, problems);
      return;
    case KeyType::formulas:
      if (value.kind == Kind::text && is_choice(value.text, key.choices)) return;
      return check_vector(key, value, true, problems);
    case KeyType::components:
    case KeyType::names:
      return check_directions(key, value, problems);
    case KeyType::groups:
      return check_groups(key, value, problems);
    case KeyType::parameters:
      return check_parameters(key, value, problems);
    case KeyType::conditions:
    case KeyType::table:  // their content is checked by check_tree, which has the whole document
      if (!value.is_table()) refuse_type(key, value, problems);
      return;
    case KeyType::tables:
      if (!value.is_table() && !value.is_list_of_tables()) refuse_type(key, value, problems);
      return;
  }
}

}  // namespace ricochet
