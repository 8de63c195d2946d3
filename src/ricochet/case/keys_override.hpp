#pragma once

#include <string>
#include <vector>

#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file Values from the command line (--set).
namespace ricochet {

/// Inserts each "key.path=value" into the document, in order, and returns the key paths (without repetitions). Unknown
/// paths are problems; throws Error(usage) for a text without "=".
std::vector<std::string> apply_overrides(TomlNode& root, const std::vector<std::string>& overrides, Problems& problems);

/// Value of the right-hand side of --set as text: the same for "0.2", "0.20" and "2e-1", for "[0,-1]" and "[0, -1.0]",
/// for a word with and without quotes.
[[nodiscard]] std::string override_value_text(const std::string& text);
/// Text "key.path=value" with the value in that form, and without blanks.
[[nodiscard]] std::string normal_override(const std::string& text);

}  // namespace ricochet
