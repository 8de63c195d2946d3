#include "ricochet/run/old_run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/rank_checkpoints.hpp"

namespace ricochet {

std::string export_directory(const RunOptions& options) {
  const bool elsewhere = !options.export_contact.empty() && !options.export_contact_to.empty();
  return elsewhere ? options.export_contact_to : (std::filesystem::path(options.output_directory) / "contact").string();
}

namespace {

/// Returns all files that a case is read from.
std::vector<std::string> input_files(const Case& input) {
  std::vector<std::string> files{input.path, input.mesh.file};
  for (const PartSection& part : input.parts) files.push_back(part.file);
  for (const ObstacleSection& obstacle : input.obstacles) {
    files.push_back(obstacle.table);
    if (obstacle.parameters.has("file")) files.push_back(obstacle.parameters.text("file"));
  }
  std::erase(files, "");
  return files;
}

}  // namespace

void refuse_overwriting_inputs(const RunDirectory& directory, const RunOptions& options, const Case& input) {
  std::vector<std::string> existing = directory.results();
  for (const std::string& file : directory.leftover_files(-1)) existing.push_back(file);
  for (const std::string& file : exported_contact_problems(export_directory(options))) existing.push_back(file);
  for (const std::string& file : input_files(input)) {
    for (const std::string& other : existing) {
      std::error_code ignored;
      if (!std::filesystem::equivalent(file, other, ignored)) continue;
      throw Error(ErrorKind::file_access,
                  fmt::format("{}: the case is read from this file, and a run into {} would overwrite it; choose "
                              "another directory with -o, or rename the file",
                              file, options.output_directory));
    }
  }
}

void refuse_old_run(const RunDirectory& directory, const RunOptions& options) {
  std::vector<std::string> results = directory.results();
  if (results.empty()) results = directory.leftover_files(-1);
  if (!results.empty()) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: already holds a run ({}); choose another directory with -o, continue that run with "
                            "--resume, or overwrite it with --force",
                            options.output_directory, std::filesystem::path(results.front()).filename().string()));
  }
  const std::string contact = export_directory(options);
  if (exported_contact_problems(contact).empty()) return;
  throw Error(
      ErrorKind::file_access,
      fmt::format(
          "{}: already holds contact problems of a run; choose another directory, or overwrite them with --force",
          contact));
}

namespace {

/// Returns an empty origin if neither summary nor checkpoint states it.
RunOrigin read_origin(const std::string& directory) {
  if (const std::optional<RunSummary> summary = find_intact_summary(directory); summary && !summary->case_path.empty())
    return {summary->case_path, summary->settings};
  std::optional<Snapshot> snapshot = newest_checkpoint(directory);
  if (!snapshot) snapshot = newest_checkpoint(checkpoint_folder_of_first_rank(directory));
  if (!snapshot) return {};
  return {snapshot->text("run.case_path"), snapshot->texts("run.settings")};
}

}  // namespace

RunOrigin find_origin(const std::string& directory) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: cannot be resumed: {}; name the case: ricochet run CASE.toml -o "
                            "{} --resume",
                            directory, why, directory));
  };
  std::error_code problem;
  if (!std::filesystem::is_directory(directory, problem)) refuse("there is no such directory");
  RunOrigin origin = read_origin(directory);
  if (origin.case_path.empty()) refuse("no run in this directory states its case");
  if (!std::filesystem::exists(origin.case_path, problem))
    refuse(fmt::format("its case file {} no longer exists", origin.case_path));
  return origin;
}

void replace_old_run(const RunDirectory& directory, const RunOptions& options, RunSummary summary) {
  const std::string contact = export_directory(options);
  const std::vector<std::string> problems = exported_contact_problems(contact);
  const std::string summary_path = directory.file("summary.json");
  remove_files(directory.leftover_files(-1));
  summary.status = "running";
  write_durably(summary_path, to_json(summary));
  std::vector<std::string> results = directory.results();
  std::erase(results, summary_path);
  remove_files(results);
  remove_files(problems);
  std::error_code problem;
  if (!problems.empty() && std::filesystem::is_empty(contact, problem)) std::filesystem::remove(contact, problem);
}

}  // namespace ricochet
