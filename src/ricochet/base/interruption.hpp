#pragma once

#include <functional>
#include <list>

/// @file Cleaning up when the process is asked to end in the middle of its work.
///
/// The thread of the program that waits for signals (apps/ricochet/stop_signal.cpp) ends the process while the main
/// thread works on, wherever that is: it may be for minutes in a library that does not handle signals.
namespace ricochet {

/// Registers an action that runs before the process is ended, such as killing a child process or removing temporary
/// files. The actions run on another thread, the newest first; a thread that creates or destroys such an object
/// meanwhile blocks until the end of the process.
class AtInterruption {
 public:
  explicit AtInterruption(std::function<void()> action);
  /// Calls `begin` first, which creates what the action removes: it never exists without the action being registered.
  /// If `begin` throws, the exception propagates and no action is registered.
  AtInterruption(const std::function<void()>& begin, std::function<void()> action);
  ~AtInterruption();
  AtInterruption(const AtInterruption&) = delete;
  AtInterruption& operator=(const AtInterruption&) = delete;

 private:
  std::list<std::function<void()>>::iterator entry_;
};

/// Marks work that checks after every step whether to stop: after a stop signal the process waits a short time for
/// that.
class StoppingPoints {
 public:
  StoppingPoints();
  ~StoppingPoints();
  StoppingPoints(const StoppingPoints&) = delete;
  StoppingPoints& operator=(const StoppingPoints&) = delete;
};

namespace interruption {

/// Reports that the work has reached a point where it stops by itself and may take the time it needs. This holds until
/// other work that has stopping points begins.
void reach_stopping_point();
[[nodiscard]] bool has_stopping_points();

/// Runs the actions. Returns false without running any if a stopping point was reached. After true the caller must end
/// the process.
[[nodiscard]] bool run_actions();

/// Writes a line to standard error unless nobody reads it.
void write_to_stderr(const char* line);

}  // namespace interruption

}  // namespace ricochet
