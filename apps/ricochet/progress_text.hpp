#pragma once

#include <string>

#include "ricochet/io/summary.hpp"

/// @file Runs in progress, interrupted or failed, in words.
namespace ricochet::program {

/// Returns the suffix of the title of an incomplete run: " (running)", " (interrupted)", " (FAILED)".
[[nodiscard]] std::string status_text(const std::string& directory, const RunSummary& summary);

/// Returns the total energy at both ends of a run, which is 0 or negative where loads have a potential, and the energy
/// to which percentages refer.
[[nodiscard]] std::string energies_text(const RunSummary& summary);

/// Returns how well the energy account balances.
[[nodiscard]] std::string energy_account_text(const RunSummary& summary);

/// Prints the progress of a run, its speed, and the ways to continue it.
void print_progress(const std::string& directory, const RunSummary& summary);

/// Describes a checkpoint, or the state left by a failed step.
void describe_checkpoint(const std::string& path);

/// Prints the time of a step and of the run, and its memory.
void print_cost(const RunSummary& s);

/// Prints the iterations of a step and, for several processes, how they divide the body and how much they send.
void print_solver(const RunSummary& s);

}  // namespace ricochet::program
