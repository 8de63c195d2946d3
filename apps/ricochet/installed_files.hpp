#pragma once

#include <string>

/// @file Files that are installed with the program.
namespace ricochet::program {

/// Returns share/ricochet/NAME beside the program (in a build directory) or beside its folder (if installed); "" if it
/// does not exist.
[[nodiscard]] std::string installed_file(const std::string& name);

}  // namespace ricochet::program
