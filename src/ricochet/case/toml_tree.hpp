#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/case/case.hpp"

/// @file TOML document as a plain tree. toml++ takes seconds to compile, so only toml_tree.cpp includes it.
namespace ricochet {

/// Value of a document, with its location.
struct TomlNode {
  enum class Kind { text, integer, real, boolean, date, list, table };

  Kind kind = Kind::table;
  std::string key;  ///< name in the enclosing table; empty in a list
  std::string text;
  std::int64_t integer = 0;
  double real = 0.0;
  bool boolean = false;
  std::vector<TomlNode> children;  ///< entries of a list, members of a table; in the order of the file
  SourceLocation location;         ///< of the value; of its header for a section
  SourceLocation key_location;     ///< of the key; of the value if there is no key
  bool is_default = false;         ///< not specified: filled in from the table of keys
  bool is_refused = false;         ///< a problem was reported: no further ones are
  bool is_ignored = false;         ///< without effect in this run; the user was informed

  [[nodiscard]] bool is_table() const { return kind == Kind::table; }
  [[nodiscard]] bool is_list_of_tables() const;
  [[nodiscard]] bool is_number() const { return kind == Kind::integer || kind == Kind::real; }
  /// Returns whether it is given by --set rather than in a file.
  [[nodiscard]] bool is_override() const { return !is_default && location.line == 0; }
  /// Member of a table, or nullptr.
  [[nodiscard]] const TomlNode* find(std::string_view name) const;
  [[nodiscard]] TomlNode* find(std::string_view name);
};

/// Parses a document; `file` is its name in locations. Throws Error(invalid_input) with line and column.
[[nodiscard]] TomlNode parse_toml(const std::string& document, const std::string& file);

/// Parses the right-hand side of an equals sign; nullopt unless it is one TOML value. All nodes get `location`.
[[nodiscard]] std::optional<TomlNode> parse_toml_value(const std::string& text, const SourceLocation& location);

/// Returns a hint to append to a message if a text is a number that a unit ("1 ms") or a percent sign follows, else "".
[[nodiscard]] std::string unit_hint(const std::string& text);

/// Value as text: texts without quotes, numbers in their shortest exact form, lists as "[1, 2]".
[[nodiscard]] std::string value_text(const TomlNode& node);

/// Description of a node for messages: `the text "abc"`, `the number 1.5`, `a table`, …
[[nodiscard]] std::string describe(const TomlNode& node);

}  // namespace ricochet
