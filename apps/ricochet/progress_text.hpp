#pragma once

#include <string>

#include "ricochet/io/summary.hpp"

/// @file Runs that go on, were interrupted or failed, in words.
namespace ricochet::program {

/// After the title of a run that is not complete: " (running)", " (interrupted)", " (FAILED)".
[[nodiscard]] std::string status_text(const std::string& directory, const RunSummary& summary);

/// How well the account of energy closes.
[[nodiscard]] std::string energy_account_text(const RunSummary& summary);

/// How far it is, how fast it goes, and what can be done with it.
void print_progress(const std::string& directory, const RunSummary& summary);

/// A checkpoint, or the state that a failed step has left.
void describe_checkpoint(const std::string& path);

/// Time of a step and of the run, and its memory.
void print_cost(const RunSummary& s);

/// Iterations of a step, and of several processes how they divide the body and what they send.
void print_solver(const RunSummary& s);

}  // namespace ricochet::program
