#pragma once

#include <string>
#include <string_view>
#include <vector>

/// @file The folders in runs/ of a study or of benchmarks. Their names are read from a file that anybody may have
/// edited, and folders are removed by them.
namespace ricochet {

/// The name of one folder, of characters that names of runs are made of: no path that leads elsewhere.
[[nodiscard]] bool is_run_folder_name(std::string_view name);

/// Throws Error(invalid_input): what is wrong with the plan in this file, and what to do. `of`: "study", "benchmarks".
[[noreturn]] void refuse_damaged_plan(const std::string& path, const std::string& why, const std::string& of);

/// Throws Error(invalid_input), which begins with `file`, where a name is none, or two are the same.
void require_run_folder_names(const std::vector<std::string>& names, const std::string& file);

/// Removes these folders from runs/ in a directory, those that are there. Throws Error(file_access) before the first is
/// gone where one of them, or runs/ itself, is a link or a file, or holds nothing that a run leaves.
void remove_run_folders(const std::string& directory, const std::vector<std::string>& names);

}  // namespace ricochet
