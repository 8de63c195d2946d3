#pragma once

/// @file SIGINT, SIGTERM and SIGHUP. During the steps of a run, the first signal requests a stop at the end of the
/// step; if that takes too long, and in all other work, the process ends in the middle of it. A second signal ends it
/// at once.
namespace ricochet::program {

/// Starts a thread that waits for signals and reports them under the name of the program; null: without messages. Must
/// be the second call in main().
void wait_for_stop_signals(const char* program_name);
void set_signal_program_name(const char* program_name);
/// Removes the limit on the duration of a step: other processes compute it as well and must not be left waiting.
void remove_step_time_limit();

/// Returns the signal that was received, or 0.
[[nodiscard]] int stop_signal();

}  // namespace ricochet::program
