#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/base/json.hpp"

/// @file The directory of a study or of benchmarks: a plan, and the folders of its runs in runs/. The names of these
/// are read from the plan, which users may have edited, and folders with these names are removed.
namespace ricochet {

/// Directory with a plan, whose runs have a `folder`.
struct PlanDirectory {
  std::string directory;

  [[nodiscard]] std::string path(const std::string& file) const;
  template <class Run>
  requires requires(const Run& run) { run.folder; }
  [[nodiscard]] std::string path(const Run& run) const { return path("runs/" + run.folder); }
};

/// Returns whether a directory has the file of a plan: "study.json", "benchmark.json".
[[nodiscard]] bool holds_plan(const std::string& directory, const std::string& file);
/// Parses such a file by `parse`. Throws VersionError, or refuse_damaged_plan() for any other error. `of`: as there.
void read_plan(const std::string& path, const std::string& of, const std::function<void(const Json& json)>& parse);

/// Returns true for the name of a single folder, made of the characters of run names, and not a path that leads
/// elsewhere.
[[nodiscard]] bool is_run_folder_name(std::string_view name);

/// Throws Error(invalid_input) that states the error of the plan in this file, and the remedy. `of`: "study",
/// "benchmarks".
[[noreturn]] void refuse_damaged_plan(const std::string& path, const std::string& why, const std::string& of);

/// Throws Error(invalid_input), which begins with `file`, if a name is invalid or two are equal.
void require_run_folder_names(const std::vector<std::string>& names, const std::string& file);

/// Removes those of these folders that exist in runs/ of a directory. Throws Error(file_access) before removing any if
/// one of them, or runs/ itself, is a link or a file, or contains no traces of a run.
void remove_run_folders(const std::string& directory, const std::vector<std::string>& names);

}  // namespace ricochet
