#pragma once

#include "ricochet/io/summary.hpp"

/// @file Results of a run in words: its impacts and its largest stress.
namespace ricochet::program {

/// Prints a line for each of the first `most` impacts (0: of all), and one with the number of the others; or a line
/// stating that there was no contact if the case has some.
void print_impacts(const RunSummary& summary, std::size_t most);
/// Prints one line, including how many of the states were examined; nothing if none was.
void print_peak_stress(const RunSummary& summary);

}  // namespace ricochet::program
