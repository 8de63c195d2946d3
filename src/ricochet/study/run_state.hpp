#pragma once

#include <optional>
#include <string>

#include "ricochet/io/summary.hpp"

/// @file What has become of a run of a study, and what is still to be done with it.
namespace ricochet {

/// How the process of a run has ended, in its directory.
inline constexpr const char* outcome_file = "outcome.json";

/// What its directory tells.
struct RunState {
  std::optional<RunSummary> summary;  ///< none: there is none, or it cannot be read
  std::string summary_json;
  bool has_checkpoint = false;
  std::optional<int> exit_status;  ///< that its last process has left, where not 0; 128 + N: signal N killed it
  std::string message;             ///< with that status, one line

  /// The status that the study gives it: that of its process where it was not 0, whatever its files say; else 0, or 5
  /// where an expectation does not hold. Nothing where it has not come to an end.
  [[nodiscard]] std::optional<int> final_status() const;
  /// "done", "refused", "failed", "interrupted" or "not run".
  [[nodiscard]] std::string word() const;
};

enum class NextAction {
  nothing,  ///< it is done; or it was refused or has failed, and would again
  resume,
  start,
};
[[nodiscard]] NextAction next_action(const RunState& state);

[[nodiscard]] RunState read_run_state(const std::string& directory);

/// Says in the directory of a run how its process has ended, for read_run_state; 0 leaves nothing.
void record_outcome(const std::string& directory, int exit_status, const std::string& message);

/// What a process has said last and loudest: the first line of its last "ricochet: …", without the name of its run.
[[nodiscard]] std::string last_error(const std::string& messages, const std::string& run_name);

/// Of two exit statuses the one that says more: defects and files before steps that failed, these before cases that
/// were refused, and last expectations that do not hold.
[[nodiscard]] int worse_status(int a, int b);

}  // namespace ricochet
