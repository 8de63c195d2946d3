#pragma once

#include <functional>
#include <string>
#include <vector>

/// @file Runs of the program, each in a process of its own, some at a time.
namespace ricochet {

/// Where a run leaves what it says, in its directory.
inline constexpr const char* messages_file = "messages.txt";

struct PooledRun {
  std::string case_path;              ///< absolute
  std::vector<std::string> settings;  ///< "key.path=value", as --set takes them
  std::string directory;              ///< of its results
};

struct RunPoolOptions {
  std::size_t jobs = 1;  ///< runs at a time
  int threads = 1;       ///< of each
  bool quiet = false;    ///< no progress
  /// Asked all the time: not 0, the number of the signal that is to end the runs.
  std::function<int()> stop_signal = {};
  std::string program = "/proc/self/exe";  ///< its command `run` runs a case
};

/// Runs those that are still to be run, as next_action says, and records in the directories how they have ended.
/// `before` is called unless there are none. Returns the signal that has stopped it, or 0. Throws Error(file_access)
/// where a directory cannot be made.
[[nodiscard]] int run_pool(const std::vector<PooledRun>& runs, const RunPoolOptions& options,
                           const std::function<void()>& before);

}  // namespace ricochet
