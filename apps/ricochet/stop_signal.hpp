#pragma once

/// @file SIGINT, SIGTERM and SIGHUP: the first asks the run to stop at the end of its step, a second one stops at once.
namespace ricochet::program {

/// First in main(): until then they wait.
void let_signals_come();

void catch_stop_signals();

/// The signal that has come, or 0.
[[nodiscard]] int stop_signal();

}  // namespace ricochet::program
