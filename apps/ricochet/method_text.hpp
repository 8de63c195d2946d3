#pragma once

#include <string>

#include "ricochet/io/summary.hpp"

/// @file What the method itself did to the energy of a run, and which reactions acted.
namespace ricochet::program {

/// "the method lost 1.2 % of the largest energy (…); reactions: mean, end weight 0 to 0.33"
void print_method(const RunSummary& summary);
/// For a table: "-1.2 %"; "0" where energy is kept to rounding. The larger one of what was lost and created.
[[nodiscard]] std::string method_energy_mark(const RunSummary& summary);
/// "mean, end weight 0 to 0.33"; empty where the scheme has no choice.
[[nodiscard]] std::string reactions_text(const RunSummary& summary);

/// "150 steps of 0.01", "71 steps of 0.001 to 0.016 (4 refused)".
[[nodiscard]] std::string steps_text(const RunSummary& summary);

}  // namespace ricochet::program
