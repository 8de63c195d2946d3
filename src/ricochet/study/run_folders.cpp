#include "ricochet/study/run_folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/study/run_pool.hpp"
#include "ricochet/study/run_state.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_to_remove(const fs::path& path, const std::string& why) {
  throw Error(
      ErrorKind::file_access,
      fmt::format("{}: {}, and is not removed: check it and remove it yourself, or choose another directory with -o",
                  path.string(), why));
}

/// Returns true for a folder of a run; an empty one belongs to a run that ended before it wrote anything.
bool looks_like_run(const fs::path& folder) {
  std::error_code problem;
  if (fs::is_empty(folder, problem) && !problem) return true;
  return holds_run(folder.string()) || fs::exists(folder / messages_file, problem) ||
         fs::exists(folder / exit_status_file, problem);
}

void require_folder(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::symlink_status(path, ignored);
  if (fs::is_symlink(status)) refuse_to_remove(path, "is a symbolic link");
  if (!fs::is_directory(status)) refuse_to_remove(path, "is not a folder");
}

}  // namespace

std::string PlanDirectory::path(const std::string& file) const { return (fs::path(directory) / file).string(); }

bool holds_plan(const std::string& directory, const std::string& file) {
  std::error_code ignored;
  return fs::exists(fs::path(directory) / file, ignored);
}

void read_plan(const std::string& path, const std::string& of, const std::function<void(const Json& json)>& parse) {
  const std::string text = read_file(path);
  try {
    const Json json = Json::parse(text);
    require_readable_version(
        path, json.value(version_attribute, ""),
        fmt::format("repeat the {} in another directory (-o), or use the version that wrote it", of));
    parse(json);
  } catch (const VersionError&) {
    throw;
  } catch (const std::runtime_error& problem) {  // of Json, or an Error
    refuse_damaged_plan(path, problem.what(), of);
  }
}

bool is_run_folder_name(std::string_view name) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("._=+-").find(c) != std::string_view::npos;
  };
  // Names that begin with a dot denote this folder, its parent, or hidden files.
  return !name.empty() && name.front() != '.' && std::ranges::all_of(name, is_plain);
}

void refuse_damaged_plan(const std::string& path, const std::string& why, const std::string& of) {
  throw Error(ErrorKind::invalid_input,
              fmt::format("{}: this file is damaged: {}; restore it from a copy, or choose another directory for the "
                          "{} with -o, or remove it and the folder \"runs\" beside it and start anew",
                          path, why, of));
}

void require_run_folder_names(const std::vector<std::string>& names, const std::string& file) {
  std::set<std::string> unique;
  for (const std::string& name : names) {
    const bool is_name = is_run_folder_name(name);
    if (is_name && unique.insert(name).second) continue;
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: \"{}\" {}", file, name,
                            is_name ? "is the folder of two runs" : "is not a valid name for the folder of a run"));
  }
}

void remove_run_folders(const std::string& directory, const std::vector<std::string>& names) {
  require_run_folder_names(names, directory);
  const fs::path runs = fs::path(directory) / "runs";
  std::error_code problem;
  if (!fs::exists(fs::symlink_status(runs, problem))) return;
  require_folder(runs);
  std::vector<fs::path> folders;
  for (const std::string& name : names) {
    if (!fs::exists(fs::symlink_status(runs / name, problem))) continue;
    require_folder(runs / name);
    if (!looks_like_run(runs / name)) refuse_to_remove(runs / name, "holds no files of a run");
    folders.push_back(runs / name);
  }
  for (const fs::path& folder : folders) {
    fs::remove_all(folder, problem);
    if (problem)
      throw Error(ErrorKind::file_access, fmt::format("{}: cannot be removed: {}", folder.string(), problem.message()));
  }
}

}  // namespace ricochet
