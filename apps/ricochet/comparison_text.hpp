#pragma once

#include <string>
#include <vector>

/// @file Several runs side by side.
namespace ricochet::program {

/// Prints the data that a reader needs to choose between runs, a row for each; then their results, with marks at
/// numbers that cannot be trusted and a line that explains each mark. Throws Error as read_summary.
void print_comparison(const std::vector<std::string>& directories);

}  // namespace ricochet::program
