#pragma once

#include <string>
#include <vector>

#include "ricochet/io/summary.hpp"

/// @file The outcome of the [[expect]] entries, in words.
namespace ricochet::program {

/// "found 3.5", or why nothing was found.
std::string found_text(const ExpectationResult& expectation);
/// How many hold; those that do not, and that some were left out. Nothing where there are none.
void print_expectations(const std::vector<ExpectationResult>& expectations);

}  // namespace ricochet::program
