#pragma once

#include <string>

#include "ricochet/io/summary.hpp"

/// @file Energy gained or lost by the method in a run, and the reactions that acted.
namespace ricochet::program {

/// Prints "the method lost 1.2 % of the largest energy (…); reactions: the mean over the step, in which those at its
/// end have the weight 0 to 0.33".
void print_method(const RunSummary& summary);
/// Returns the larger of the losses and gains for a table: "-1.2 %"; "0" if energy is kept up to rounding.
[[nodiscard]] std::string method_energy_mark(const RunSummary& summary);
/// Returns "the mean over the step, in which …" or "those at the end of the step"; empty if the scheme has no choice.
[[nodiscard]] std::string reactions_text(const RunSummary& summary);

/// Returns "150 steps of 0.01" or "71 steps of 0.001 to 0.016 (4 refused)".
[[nodiscard]] std::string steps_text(const RunSummary& summary);

}  // namespace ricochet::program
