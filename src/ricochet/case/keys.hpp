#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// @file The table of everything a case file may say. Reading, checking, the JSON Schema and the documentation page are
/// all driven by it. A new key is one entry in keys_table*.cpp and one line in read_sections.cpp that puts it into the
/// Case.
namespace ricochet {

enum class KeyType {
  text,        ///< any text; not empty when required
  choice,      ///< one of `choices`
  number,      ///< finite, within `range`
  integer,     ///< within `range`, or one of `choices`
  vector,      ///< 2 or 3 numbers
  formula,     ///< a number or an expression in `variables`
  formulas,    ///< 2 or 3 of them, or one of `choices`
  components,  ///< a list of distinct `choices`, which name the directions of space
  names,       ///< a list of distinct `choices`
  groups,      ///< the name of a group of the mesh, or a list of distinct ones: their union
  parameters,  ///< a table of numbers, for the expressions beside it
  conditions,  ///< a table of key paths and the values they must have
  table,       ///< a sub-table with `keys`
};

/// Bounds of a number.
struct Range {
  std::optional<double> above = {};
  std::optional<double> at_least = {};
  std::optional<double> below = {};
  std::optional<double> at_most = {};
};

struct Key {
  std::string name;
  KeyType type = KeyType::text;
  std::string unit = {};  ///< the kind of unit ("length", "stress"; "1": a pure number); empty where there is none
  bool required = false;
  std::optional<std::string> standard = {};  ///< the default, as text
  std::vector<std::string> choices = {};
  Range range = {};
  std::string variables = {};  ///< of expressions: "t", "x, y and z" or "x, y, z and t"
  std::vector<Key> keys = {};  ///< of a sub-table
  bool decides = false;        ///< which other keys there are: where its value is refused, nothing else is looked at
  std::string doc;             ///< one line of documentation
};

enum class SectionKind {
  top,    ///< keys before the first section
  table,  ///< [name]
  list,   ///< [[name]], any number of them
  named,  ///< [name.NAME], any number of them
};

struct Section {
  std::string name;
  SectionKind kind = SectionKind::table;
  bool required = false;
  /// Sets of keys of which exactly one must be given, whole.
  std::vector<std::vector<std::string>> alternatives = {};
  std::string doc;
  std::vector<Key> keys;
};

/// Values of beta and gamma that go by a name.
struct NewmarkPreset {
  std::string name;
  double beta, gamma;
};
[[nodiscard]] const std::vector<NewmarkPreset>& newmark_presets();

/// All sections, the top of the file first.
[[nodiscard]] const std::vector<Section>& case_sections();

/// The section or key of that name, or nullptr.
[[nodiscard]] const Section* find_section(std::string_view name);
[[nodiscard]] const Key* find_key(const std::vector<Key>& keys, std::string_view name);

/// As it is written in a file: "[mesh]", "[[contact]]", "[obstacle.NAME]".
[[nodiscard]] std::string section_title(const Section& section);

/// What a key wants: "a positive number", `one of "a" or "b"`, …
[[nodiscard]] std::string wanted(const Key& key);
/// The same with its unit, where it has one.
[[nodiscard]] std::string wanted_with_unit(const Key& key);

/// The key or section that an unknown name was probably meant to be, or "".
[[nodiscard]] std::string nearest_key(std::string_view name, const std::vector<Key>& keys);
[[nodiscard]] std::string nearest_section(std::string_view name);

/// `unknown key "densty" in [[material]]; did you mean "density"?`
[[nodiscard]] std::string unknown_key_message(std::string_view name, const std::string& title,
                                              const std::vector<Key>& keys);
[[nodiscard]] std::string unknown_section_message(std::string_view name);

/// What a dotted path such as "contact.0.friction", "obstacle.floor.normal" or "material.0.damping.mass" stands for.
struct KeyPath {
  const Section* section = nullptr;
  std::string entry;         ///< number in a list, name of a named section; else empty
  const Key* key = nullptr;  ///< the sub-table's key for a path into a sub-table
  std::string sub_table;     ///< name of the sub-table, parameters or conditions it goes into; else empty
  std::string member;        ///< name of the parameter or condition; else empty
};

/// Throws Error(invalid_input) that says which part of the path is not known.
[[nodiscard]] KeyPath parse_key_path(const std::string& path);

/// Letters, digits, _ and -, at least one.
[[nodiscard]] bool is_plain_name(std::string_view name);

}  // namespace ricochet
