#pragma once

#include <string>

#include "ricochet/io/summary.hpp"

/// @file Interpenetration and rotation of a run, in words.
namespace ricochet::program {

/// Returns the line(s) of `run` and `info`, each with the program's two leading spaces, without the last line break.
[[nodiscard]] std::string deformation_text(const RunSummary& summary);
/// Returns the entry of the table that compares runs, with ≥ if only contact points were examined.
[[nodiscard]] std::string deepest_penetration_text(const RunSummary& summary);

}  // namespace ricochet::program
