#pragma once

#include <functional>
#include <string>
#include <vector>

/// @file Runs of the program, each in a process of its own, several at a time.
namespace ricochet {

/// File of the messages of a run, in its directory.
inline constexpr const char* messages_file = "messages.txt";

struct PooledRun {
  std::string case_path;              ///< absolute
  std::vector<std::string> settings;  ///< "key.path=value", as passed to --set
  std::string directory;              ///< directory of its results
};

struct RunPoolOptions {
  std::size_t jobs = 1;  ///< number of simultaneous runs
  int threads = 1;       ///< per run
  bool quiet = false;    ///< no progress
  /// Polled continuously; if not 0, the number of the signal that ends the runs.
  std::function<int()> stop_signal = {};
  std::string program = "/proc/self/exe";  ///< program whose command `run` runs a case
};

/// Computes the runs that next_action does not regard as complete, and records in their directories how they ended.
/// `before` is called unless there are none. Returns the signal that has stopped it, or 0. Throws Error(file_access) if
/// a directory cannot be created.
[[nodiscard]] int run_pool(const std::vector<PooledRun>& runs, const RunPoolOptions& options,
                           const std::function<void()>& before);

}  // namespace ricochet
