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

}  // namespace ricochet
