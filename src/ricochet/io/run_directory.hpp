#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/interruption.hpp"
#include "ricochet/base/ranks.hpp"

/// @file The directory that a run writes into, for one run at a time.
namespace ricochet {

class RunDirectory {
 public:
  /// Makes the directory where it is missing, and keeps other runs out of it until this object or the process ends,
  /// however it ends. Throws Error(file_access): it cannot be made or written to, or another run is in it.
  /// All ranks make one together; the first has the directory for all.
  explicit RunDirectory(std::string path, const Ranks& ranks = one_rank());
  /// Removes the directory again where this object has made it and nothing has been written into it.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const;
  /// Results that a run has left here, and its summary.
  [[nodiscard]] std::vector<std::string> results() const;
  /// Files that an interrupted run has left here and that a run which goes on after this step has no use for:
  /// unfinished ones, what is left of a step that failed, and checkpoints of later steps, which are damaged. All that
  /// are no results: of step −1.
  [[nodiscard]] std::vector<std::string> left_behind(long step) const;

  /// Is a run writing into this directory now?
  [[nodiscard]] static bool is_in_use(const std::string& path);

 private:
  void take();

  std::string path_;
  int lock_ = -1;
  bool is_new_ = false;
  std::optional<AtInterruption> at_interruption_;
};

/// Whether a run has left a summary or a checkpoint there.
[[nodiscard]] bool holds_run(const std::string& directory);

/// Removes files. Throws Error(file_access).
void remove_files(const std::vector<std::string>& files);

}  // namespace ricochet
