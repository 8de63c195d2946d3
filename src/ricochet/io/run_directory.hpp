#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/interruption.hpp"
#include "ricochet/base/ranks.hpp"

/// @file Output directory of a run, reserved for one run at a time.
namespace ricochet {

class RunDirectory {
 public:
  /// Creates the directory if it is missing, and excludes other runs from it until this object is destroyed or the
  /// process ends, however it ends. Throws Error(file_access) if it cannot be created or written to, or another run
  /// uses it.
  /// All ranks construct one together; the first reserves the directory for all.
  explicit RunDirectory(std::string path, const Ranks& ranks = one_rank());
  /// Removes the directory if this object has created it and it is empty.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const;
  /// Existing result files of a run, including its summary.
  [[nodiscard]] std::vector<std::string> results() const;
  /// Files of an interrupted run that are of no use to a run resumed after this step: unfinished files, those of a
  /// failed step, and checkpoints of later steps, which are damaged. For step −1 all files that are not results.
  [[nodiscard]] std::vector<std::string> leftover_files(long step) const;

  /// Returns whether a run is writing into this directory.
  [[nodiscard]] static bool is_in_use(const std::string& path);

 private:
  void reserve();

  std::string path_;
  int lock_ = -1;
  bool is_new_ = false;
  std::optional<AtInterruption> at_interruption_;
};

/// Returns whether the directory contains a summary or a checkpoint.
[[nodiscard]] bool holds_run(const std::string& directory);

/// Removes files. Throws Error(file_access).
void remove_files(const std::vector<std::string>& files);

}  // namespace ricochet
