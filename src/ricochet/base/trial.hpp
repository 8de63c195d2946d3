#pragma once

#include <functional>
#include <string>

/// @file Work that may crash or never end, such as reading a damaged file with a library, tried in a copy of this
/// process.
namespace ricochet {

struct TrialResult {
  bool succeeded = false;  ///< the work ended and returned true
  int signal = 0;          ///< the signal that killed the copy; 0 if it ended by itself
  bool endless = false;    ///< it was killed because it took too long

  /// Returns "crashed with signal 11", "does not end", "failed".
  [[nodiscard]] std::string description() const;
};

/// Calls `work` in a forked child, which prints nothing, dumps no core and ends with this process, and waits for it.
/// Other threads do not exist in the child: `work` must not need anything they may hold. The child is killed after
/// `processor_seconds`. Throws Error(file_access) if no child can be created.
[[nodiscard]] TrialResult try_in_child(const std::function<bool()>& work, double processor_seconds);

}  // namespace ricochet
