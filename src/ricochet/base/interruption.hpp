#pragma once

#include <functional>
#include <list>

/// @file A process that is asked to end in the middle of its work: what is to be put in order before it does.
///
/// Who asks (the program's thread that waits for signals, apps/ricochet/stop_signal.cpp) ends the process while the
/// main thread works on, wherever that is: in a library that knows nothing of signals it may be for minutes.
namespace ricochet {

/// While such an object lives, its action is taken before the process is ended: a child process is killed, temporary
/// files are removed. The actions run on another thread, the newest first; whoever makes or destroys such an object
/// meanwhile waits for the end.
class AtInterruption {
 public:
  explicit AtInterruption(std::function<void()> action);
  /// Calls `begin` first, which makes what the action will remove: it never exists without the action being registered.
  /// What `begin` throws is thrown, and there is no action then.
  AtInterruption(const std::function<void()>& begin, std::function<void()> action);
  ~AtInterruption();
  AtInterruption(const AtInterruption&) = delete;
  AtInterruption& operator=(const AtInterruption&) = delete;

 private:
  std::list<std::function<void()>>::iterator entry_;
};

/// While such an object lives, somebody asks after every step whether to stop: there is a little time until then.
class StoppingPoints {
 public:
  StoppingPoints();
  ~StoppingPoints();
  StoppingPoints(const StoppingPoints&) = delete;
  StoppingPoints& operator=(const StoppingPoints&) = delete;
};

namespace interruption {

/// The work has come to a point where it can stop and does so by itself: it may take the time it needs. That holds
/// until other work begins to have stopping points.
void reach_stopping_point();
[[nodiscard]] bool has_stopping_points();

/// Takes the actions. Returns false, and has done nothing, where a stopping point was reached. After true the process
/// must be ended.
[[nodiscard]] bool take_actions();

/// A line on standard error, unless nobody takes it.
void say(const char* line);

}  // namespace interruption

}  // namespace ricochet
