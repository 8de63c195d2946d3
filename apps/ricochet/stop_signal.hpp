#pragma once

/// @file SIGINT, SIGTERM and SIGHUP. While a run takes steps the first asks it to stop at the end of its step; where
/// that takes too long, and in all other work, the process ends in the middle of it. A second one ends it at once.
namespace ricochet::program {

/// Second in main(): a thread waits for signals from here on, and says so under the name of the program; null: it says
/// nothing.
void wait_for_stop_signals(const char* program_name);
void say_signals_as(const char* program_name);
/// A step has all the time that it needs from here on: others take it, too, and must not be left alone in it.
void let_steps_end();

/// The signal that has come, or 0.
[[nodiscard]] int stop_signal();

}  // namespace ricochet::program
