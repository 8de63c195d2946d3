#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/base/parameters.hpp"

/// @file Table of all sections and keys of a case file. It drives reading, checking, the JSON Schema and the
/// documentation page. A key of a registered type (a scheme, an obstacle, a law) is declared with the type; every other
/// key is one entry in keys_table*.cpp, which names the member of the Case that stores its value (key_member.hpp).
namespace ricochet {

struct TomlNode;

enum class SectionKind {
  top,    ///< keys before the first section
  table,  ///< [name]
  list,   ///< [[name]], any number of them
  named,  ///< [name.NAME], any number of them
};

/// Keys of a registered type.
struct TypeKeys {
  std::string name;
  std::vector<Key> keys;
  KeySets alternatives = {};
  std::function<void(const ParameterCheck& check, Parameters& values)> check = {};
};

struct Section {
  std::string name;
  SectionKind kind = SectionKind::table;
  bool required = false;
  std::string replaced_by = {};  ///< not required if this section has entries
  KeySets alternatives = {};
  /// Tests for entries that need none of the alternatives, and their description for messages; null if there are none.
  bool (*stands_alone)(const TomlNode& entry) = nullptr;
  std::string alone = {};
  std::string doc = {};
  std::vector<Key> keys = {};  ///< including those of all types
  /// Key that names a registered type, and the types with their own keys; empty if there are none.
  std::string type_key = {};
  std::vector<TypeKeys> types = {};
};

[[nodiscard]] const TypeKeys* find_type(const Section& section, std::string_view name);

/// All sections, beginning with the top of the file.
[[nodiscard]] const std::vector<Section>& case_sections();

/// Section or key of that name, or nullptr.
[[nodiscard]] const Section* find_section(std::string_view name);
[[nodiscard]] const Key* find_key(const std::vector<Key>& keys, std::string_view name);

/// Title as written in a file: "[mesh]", "[[contact]]", "[obstacle.NAME]".
[[nodiscard]] std::string section_title(const Section& section);

/// Description of a key's values, with the unit if it has one.
[[nodiscard]] std::string admissible_with_unit(const Key& key);

/// Key or section that an unknown name was probably meant to be, or "".
[[nodiscard]] std::string nearest_key(std::string_view name, const std::vector<Key>& keys);
[[nodiscard]] std::string nearest_section(std::string_view name);

/// Message `unknown key "densty" in [[material]]; did you mean "density"?`.
[[nodiscard]] std::string unknown_key_message(std::string_view name, const std::string& title,
                                              const std::vector<Key>& keys);
[[nodiscard]] std::string unknown_section_message(std::string_view name);

/// Parsed dotted path such as "contact.0.friction", "obstacle.floor.normal" or "material.0.damping.mass".
struct KeyPath {
  const Section* section = nullptr;
  std::string entry;         ///< number in a list, name of a named section; else empty
  const Key* key = nullptr;  ///< the sub-table's key for a path into a sub-table
  std::string sub_table;     ///< name of the sub-table, parameters or conditions that contain the key; else empty
  std::string sub_entry;     ///< number of the sub-table in a list of them; else empty
  std::string member;        ///< name of the parameter or condition; else empty
};

/// Returns a path with the numbers of entries as key paths have them: "contact.0.friction" for "contact[0].friction".
[[nodiscard]] std::string with_dotted_numbers(std::string_view path);

/// Throws Error(invalid_input), which names the unknown part of the path.
[[nodiscard]] KeyPath parse_key_path(const std::string& path);

/// Returns whether a name consists of letters, digits, _ and -, at least one.
[[nodiscard]] bool is_plain_name(std::string_view name);

}  // namespace ricochet
