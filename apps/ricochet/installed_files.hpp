#pragma once

#include <string>

/// @file Files that come with the program.
namespace ricochet::program {

/// share/ricochet/NAME beside the program (in a build directory) or beside the folder it is in (where it is installed);
/// empty: it is not there.
[[nodiscard]] std::string installed_file(const std::string& name);

}  // namespace ricochet::program
