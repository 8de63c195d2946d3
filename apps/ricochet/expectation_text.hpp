#pragma once

#include <string>
#include <vector>

#include "ricochet/io/summary.hpp"

/// @file Results of the [[expect]] entries, in words.
namespace ricochet::program {

/// Returns "found 3.5", or the reason why nothing was found.
std::string found_text(const ExpectationResult& expectation);
/// Prints how many hold, those that do not, and whether some were left out; nothing if there are no entries.
void print_expectations(const std::vector<ExpectationResult>& expectations);

}  // namespace ricochet::program
