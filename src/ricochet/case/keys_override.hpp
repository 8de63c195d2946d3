#pragma once

#include <string>
#include <vector>

#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file Values given on the command line.
namespace ricochet {

/// Puts each "key.path=value" into the document, in order, and returns the key paths (without repetitions). Unknown
/// paths are problems; a text without "=" is Error(usage).
std::vector<std::string> apply_overrides(TomlNode& root, const std::vector<std::string>& overrides, Problems& problems);

/// The value that the right-hand side of --set gives, as text: the same for "0.2", "0.20" and "2e-1", for "[0,-1]" and
/// "[0, -1.0]", for a word with and without quotes.
[[nodiscard]] std::string override_value_text(const std::string& text);
/// "key.path=value" with that text in the place of the value, and without blanks.
[[nodiscard]] std::string normal_override(const std::string& text);

}  // namespace ricochet
