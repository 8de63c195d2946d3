#pragma once

#include <optional>
#include <string>

#include "ricochet/io/summary.hpp"

/// @file State of a run of a study, and the next action for it.
namespace ricochet {

/// File in the directory of a run that states how its process ended.
inline constexpr const char* exit_status_file = "outcome.json";

/// State of a run, read from its directory.
struct RunState {
  std::optional<RunSummary> summary;  ///< none if it does not exist or cannot be read
  std::string summary_json;
  bool has_checkpoint = false;
  std::optional<int> exit_status;  ///< nonzero status of its last process; 128 + N: killed by signal N
  std::string message;             ///< message of one line that belongs to that status
  /// Names both versions if another one has written the summary; such a run counts as not run. Otherwise empty.
  std::string other_version;

  /// Returns the status of the run in the study: a nonzero status of its process takes precedence over its files; else
  /// 0, or 5 if an expectation does not hold. None if the run has not ended.
  [[nodiscard]] std::optional<int> final_status() const;
  /// Returns "done", "refused", "failed", "interrupted" or "not run".
  [[nodiscard]] std::string status_text() const;
};

enum class NextAction {
  nothing,  ///< it is done, was refused, or has failed and would again
  resume,
  start,
};
[[nodiscard]] NextAction next_action(const RunState& state);

[[nodiscard]] RunState read_run_state(const std::string& directory);

/// Warns if a run, which is repeated now, is one of another version.
void warn_of_other_version(const RunState& state);

/// Records in the directory of a run how its process has ended, for read_run_state; a status of 0 leaves no record.
void record_exit_status(const std::string& directory, int exit_status, const std::string& message);

/// Returns the first line of the last "ricochet: …" message of a process, without the name of its run.
[[nodiscard]] std::string last_error(const std::string& messages, const std::string& run_name);

/// Returns the more serious of two exit statuses: defects and file errors, then steps that failed, then cases that were
/// refused, and last expectations that do not hold.
[[nodiscard]] int worse_status(int a, int b);

}  // namespace ricochet
