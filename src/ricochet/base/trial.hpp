#pragma once

#include <functional>
#include <string>

/// @file Work that may crash or never end, as what a library does with a damaged file, tried in a copy of this process.
namespace ricochet {

struct TrialOutcome {
  bool succeeded = false;  ///< the work came to its end and returned true
  int signal = 0;          ///< that killed the copy; 0: it ended by itself
  bool endless = false;    ///< it was killed since it took too long

  /// "ended a process with signal 11", "does not come to an end", "failed".
  [[nodiscard]] std::string description() const;
};

/// Calls `work` in a child made by fork, which says nothing, leaves no core and ends with this process, and waits for
/// it. Of other threads the child knows nothing: `work` must not need what they may hold. `processor_seconds`: after as
/// many the child is killed. Throws Error(file_access) where no child can be made.
[[nodiscard]] TrialOutcome try_in_child(const std::function<bool()>& work, double processor_seconds);

}  // namespace ricochet
