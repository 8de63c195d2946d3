#pragma once

#include <string>

/// @file Files that are installed with the program.
namespace ricochet::program {

/// Returns share/ricochet/NAME beside the program (in a build directory) or beside its folder (if installed). Throws
/// Error(file_access), with what it is and the advice, if it does not exist.
[[nodiscard]] std::string installed_file(const std::string& name, const std::string& what,
                                         const std::string& advice = "build or install Ricochet again");
/// Returns the list of the benchmarks that are installed.
[[nodiscard]] std::string benchmark_manifest();

}  // namespace ricochet::program
