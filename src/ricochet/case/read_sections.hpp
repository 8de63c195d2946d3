#pragma once

#include "ricochet/case/case.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file Conversion of a checked document to a Case, with the checks that concern more than one key.
namespace ricochet {

/// Fills all sections of `result`, but not its locations and values.
void read_sections(const TomlNode& root, Case& result, Problems& problems);

}  // namespace ricochet
