#pragma once

#include <string>

#include "ricochet/io/summary.hpp"

/// @file Interpenetration and rotation of a run, in words.
namespace ricochet::program {

/// The line(s) of `run` and `info`, with the program's two spaces before each, without the last line break.
[[nodiscard]] std::string deformation_text(const RunSummary& summary);
/// The entry of the table that compares runs: with ≥ where only contact points were looked at.
[[nodiscard]] std::string deepest_penetration_text(const RunSummary& summary);

}  // namespace ricochet::program
