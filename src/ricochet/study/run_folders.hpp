#pragma once

#include <string>
#include <string_view>
#include <vector>

/// @file The folders in runs/ of a study or of benchmarks. Their names are read from a file that users may have edited,
/// and folders with these names are removed.
namespace ricochet {

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
