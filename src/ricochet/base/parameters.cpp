#include "ricochet/base/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

template <class Type>
const Type& value_of(const std::map<std::string, Parameters::Value>& values, const std::string& name) {
  const auto found = values.find(name);
  if (found == values.end())
    throw Error(ErrorKind::invalid_input, fmt::format("the parameter \"{}\" is missing", name));
  const Type* const value = std::get_if<Type>(&found->second);
  if (value == nullptr) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("the parameter \"{}\" has a value of the wrong type: {}", name, as_text(found->second)));
  }
  return *value;
}

Parameters::Value standard_value(const Key& key) {
  const bool is_number = key.type == KeyType::number || key.type == KeyType::integer;
  if (is_number) return std::strtod(key.default_value->c_str(), nullptr);
  return *key.default_value;
}

bool fits(const Key& key, const Parameters::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    const bool is_whole = key.type == KeyType::integer && *number == std::trunc(*number);
    const bool is_choice = key.choices.empty() || std::ranges::any_of(key.choices, [&](const std::string& choice) {
                             return std::strtod(choice.c_str(), nullptr) == *number;
                           });
    return (key.type == KeyType::number || is_whole) && is_choice && std::isfinite(*number) &&
           is_within(key.range, *number);
  }
  if (const auto* text = std::get_if<std::string>(&value)) {
    const bool is_choice = std::ranges::find(key.choices, *text) != key.choices.end();
    return key.type == KeyType::text || (key.type == KeyType::choice && is_choice);
  }
  const auto& vector = std::get<std::vector<double>>(value);
  return key.type == KeyType::vector && (vector.size() == 2 || vector.size() == 3) &&
         std::ranges::all_of(vector, [](double component) { return std::isfinite(component); });
}

}  // namespace

double Parameters::number(const std::string& name) const { return value_of<double>(values_, name); }

const std::string& Parameters::text(const std::string& name) const { return value_of<std::string>(values_, name); }

const std::vector<double>& Parameters::vector(const std::string& name) const {
  return value_of<std::vector<double>>(values_, name);
}

void Parameters::complete(const std::vector<Key>& keys, const std::string& owner) {
  for (const auto& [name, value] : values_) {
    if (std::ranges::any_of(keys, [&n = name](const Key& key) { return key.name == n; })) continue;
    throw Error(ErrorKind::invalid_input,
                fmt::format("{} has no parameter \"{}\"; {}", owner, name,
                            keys.empty() ? "it has none" : "it has " + join_names(names_of(keys))));
  }
  for (const Key& key : keys) {
    if (has(key.name)) {
      if (!fits(key, values_.at(key.name))) {
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{}: the parameter \"{}\" is {}; it must be {}", owner, key.name,
                                as_text(values_.at(key.name)), admissible_values(key)));
      }
      continue;
    }
    if (key.required)
      throw Error(ErrorKind::invalid_input, fmt::format("{} needs the parameter \"{}\"", owner, key.name));
    if (key.default_value) set(key.name, standard_value(key));
  }
}

std::string as_text(const Parameters::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  std::string list;
  for (const double component : std::get<std::vector<double>>(value))
    list += fmt::format("{}{}", list.empty() ? "" : ", ", component);
  return "[" + list + "]";
}

}  // namespace ricochet
