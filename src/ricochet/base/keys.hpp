#pragma once

#include <functional>
#include <optional>
#include <string>
#include <typeinfo>
#include <vector>

/// @file Keys of a case file and their admissible values. A type that has parameters (a scheme, an obstacle, a material
/// law) declares its keys where it is defined; case/keys.hpp collects all keys in one table.
namespace ricochet {

enum class KeyType {
  text,            ///< any text; not empty if required
  choice,          ///< one of `choices`
  number,          ///< finite, within `range`, or one of `choices`
  integer,         ///< within `range`, or one of `choices`
  flag,            ///< true or false
  vector,          ///< 2 or 3 numbers
  numbers,         ///< one or more, each within `range`
  axial,           ///< axial vector of a rotation: a number in two dimensions, 3 numbers in three
  formula,         ///< a number or an expression in `variables`
  formulas,        ///< 2 or 3 formulas, or one of `choices`
  axial_formulas,  ///< axial vector of a rotation: a formula in two dimensions, 3 formulas in three
  components,      ///< a list of distinct `choices`, which name the directions of space
  names,           ///< a list of distinct `choices`
  groups,          ///< the name of a group of the mesh, or a list of distinct ones: their union
  parameters,      ///< a table of numbers, for the expressions beside it
  conditions,      ///< a table of key paths and the values required of them
  table,           ///< a sub-table with `keys`
  tables,          ///< a sub-table with `keys`, or a list of them
};

/// Bounds of a number.
struct Range {
  std::optional<double> above = {};
  std::optional<double> at_least = {};
  std::optional<double> below = {};
  std::optional<double> at_most = {};
};
inline const Range positive{.above = 0.0};
inline const Range nonnegative{.at_least = 0.0};

class SectionReader;  // of case
struct Key;

/// Member of a struct in which the value of a key is stored (case/key_member.hpp).
struct KeyMember {
  const std::type_info* owner = nullptr;  ///< the struct
  /// Stores the value in the member of an object.
  std::function<void(const SectionReader& section, const Key& key, void* object)> store = {};
};

struct Key {
  std::string name = {};
  KeyType type = KeyType::text;
  std::string unit = {};  ///< the kind of unit ("length", "stress"; "1": dimensionless); empty if none
  bool required = false;
  std::optional<std::string> default_value = {};  ///< the default, as text
  std::vector<std::string> choices = {};
  Range range = {};
  std::string variables = {};  ///< variables of expressions: "t", "x, y and z" or "x, y, z and t"
  std::vector<Key> keys = {};  ///< keys of a sub-table
  bool decides = false;        ///< its value decides which other keys exist: if it is refused, no other key is checked
  /// Section whose entries replace this key: if it has any, the key is refused; otherwise it may be required.
  std::string replaced_by = {};
  std::string doc = {};  ///< one line of documentation
  /// Types that have this key, filled in by the table; empty: it belongs to the section whatever the type.
  std::vector<std::string> only_for = {};
  std::vector<KeyMember> members = {};  ///< empty: other code reads the value
};

/// Properties of a key that must be given.
[[nodiscard]] inline Key required(Range range = {}) { return {.required = true, .range = range}; }
/// Key of a type; `properties` is everything that is not among the other arguments.
[[nodiscard]] Key typed_key(std::string name, KeyType type, std::string unit, Key properties, std::string doc);
[[nodiscard]] Key number_key(std::string name, std::string unit, Key properties, std::string doc);
[[nodiscard]] Key vector_key(std::string name, std::string unit, Key properties, std::string doc);
[[nodiscard]] Key choice_key(std::string name, std::vector<std::string> choices, Key properties, std::string doc);

[[nodiscard]] inline std::vector<std::string> names_of(const std::vector<Key>& keys) {
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (const Key& key : keys) names.push_back(key.name);
  return names;
}
/// Returns what the value of a key must be: "a positive number", `one of "a" or "b"`, …
[[nodiscard]] std::string admissible_values(const Key& key);
[[nodiscard]] bool is_within(const Range& range, double value);

/// Sets of keys of which exactly one must be given, complete.
using KeySets = std::vector<std::vector<std::string>>;

}  // namespace ricochet
