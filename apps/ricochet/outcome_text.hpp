#pragma once

#include "ricochet/io/summary.hpp"

/// @file What came out of a run, in words: its impacts and its largest stress.
namespace ricochet::program {

/// A line per impact, of the first `most` (0: of all), and one that says how many more there are; or one that says that
/// there was no contact where the case has some.
void print_impacts(const RunSummary& summary, std::size_t most);
/// One line, which also says how many of the states were looked at; nothing where none was.
void print_peak_stress(const RunSummary& summary);

}  // namespace ricochet::program
