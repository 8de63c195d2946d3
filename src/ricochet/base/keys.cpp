#include "ricochet/base/keys.hpp"

#include <fmt/format.h>

#include <utility>

#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

std::string with_range(const std::string& noun, const Range& range) {
  const std::string article = noun == "integer" ? "an" : "a";
  if (range.above == 0.0 && !range.below && !range.at_most) return fmt::format("a positive {}", noun);
  std::vector<std::string> bounds;
  if (range.above) bounds.push_back(fmt::format("above {}", *range.above));
  if (range.at_least) bounds.push_back(fmt::format("of at least {}", *range.at_least));
  if (range.below) bounds.push_back(fmt::format("below {}", *range.below));
  if (range.at_most) bounds.push_back(fmt::format("of at most {}", *range.at_most));
  if (bounds.empty()) return fmt::format("{} {}", article, noun);
  return fmt::format("{} {} {}", article, noun, join_names(bounds, " and ", false));
}

std::string one_of(const std::vector<std::string>& choices, bool quoted) {
  return fmt::format("{}{}", choices.size() > 2 ? "one of " : "", join_names(choices, " or ", quoted));
}

}  // namespace

std::string admissible_values(const Key& key) {
  switch (key.type) {
    case KeyType::text:
      return key.required ? "a text that is not empty" : "a text";
    case KeyType::choice:
      return one_of(key.choices, true);
    case KeyType::number:
      return with_range("number", key.range) + (key.choices.empty() ? "" : ", or " + one_of(key.choices, true));
    case KeyType::integer:
      return key.choices.empty() ? with_range("integer", key.range) : one_of(key.choices, false);
    case KeyType::flag:
      return "true or false";
    case KeyType::vector:
      return "a vector of 2 or 3 numbers";
    case KeyType::numbers:
      return fmt::format("a list whose entries are each {}", with_range("number", key.range));
    case KeyType::axial:
      return "a number in two dimensions, a vector of 3 numbers in three";
    case KeyType::formula:
      return fmt::format("a number or an expression in {}", key.variables);
    case KeyType::formulas:
      return fmt::format("a vector of 2 or 3 numbers or expressions in {}{}", key.variables,
                         key.choices.empty() ? "" : ", or " + one_of(key.choices, true));
    case KeyType::axial_formulas:
      return fmt::format("a number or an expression in {} in two dimensions, a vector of 3 of them in three",
                         key.variables);
    case KeyType::components:
    case KeyType::names:
      return fmt::format("a list with one or more of {}", join_names(key.choices, " and "));
    case KeyType::groups:
      return "the name of a group, or a list of them";
    case KeyType::parameters:
      return "a table of numbers";
    case KeyType::conditions:
      return "a table of key paths and their values";
    case KeyType::table:
      return fmt::format("a table with {}", join_names(names_of(key.keys)));
    case KeyType::tables:
      return fmt::format("a table with {}, or a list of them", join_names(names_of(key.keys)));
  }
  return "";
}

bool is_within(const Range& range, double value) {
  return !(range.above && !(value > *range.above)) && !(range.at_least && !(value >= *range.at_least)) &&
         !(range.below && !(value < *range.below)) && !(range.at_most && !(value <= *range.at_most));
}

Key typed_key(std::string name, KeyType type, std::string unit, Key properties, std::string doc) {
  properties.name = std::move(name);
  properties.type = type;
  properties.unit = std::move(unit);
  properties.doc = std::move(doc);
  return properties;
}
Key number_key(std::string name, std::string unit, Key properties, std::string doc) {
  return typed_key(std::move(name), KeyType::number, std::move(unit), std::move(properties), std::move(doc));
}
Key vector_key(std::string name, std::string unit, Key properties, std::string doc) {
  return typed_key(std::move(name), KeyType::vector, std::move(unit), std::move(properties), std::move(doc));
}
Key choice_key(std::string name, std::vector<std::string> choices, Key properties, std::string doc) {
  properties.choices = std::move(choices);
  return typed_key(std::move(name), KeyType::choice, "", std::move(properties), std::move(doc));
}

}  // namespace ricochet
