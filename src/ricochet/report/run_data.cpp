#include "ricochet/report/run_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

/// Returns the files probes-N.csv, ordered by name.
std::vector<std::string> probe_files(const std::string& directory) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("probes-") && name.ends_with(".csv")) files.push_back(name);
  }
  std::ranges::sort(files);
  return files;
}

void check_rows(const std::string& path, const HistoryTable& table) {
  const auto time = table.columns.find("time");
  if (time == table.columns.end())
    throw Error(ErrorKind::invalid_input, fmt::format("{}:1: there is no column \"time\"", path));
  const std::vector<double>& times = time->second;
  if (times.empty()) throw Error(ErrorKind::invalid_input, fmt::format("{}: there are no rows yet", path));
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isfinite(times[i]) && (i == 0 || times[i] >= times[i - 1])) continue;
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("{}:{}: the time {} is not finite, or earlier than that of the row before", path, i + 2, times[i]));
  }
}

void read_results(RunData& run) {
  const ResultsFormat* const format = find_results_format(run.directory);
  if (format != nullptr) {
    run.results = std::make_unique<ResultsReader>(run.directory, run.summary.dimension, run.summary.degree);
    if (fs::exists(fs::path(run.directory) / format->obstacles)) {
      run.obstacles = format->read_obstacles(run.directory, *format);
      if (run.obstacles.size() < run.results->times().size()) {
        run.notes.push_back(fmt::format("{} has {} of {} frames: it is damaged", format->obstacles,
                                        run.obstacles.size(), run.results->times().size()));
      }
    }
    if (run.results->times().empty()) run.results.reset();
  }
  const auto found = long(run.results ? run.results->times().size() : 0);
  if (run.summary.status != "running" && found < run.summary.frames) {
    const auto names = [](const ResultsFormat& each) { return each.file_names(); };
    const bool is_one_file = format != nullptr && format->files.size() == 1;
    run.notes.push_back(fmt::format(
        "{} {} {} of the {} frames that were written: {} {}",
        format != nullptr ? names(*format) : fmt::format("the field files ({})", any_format(names, ", or ")),
        is_one_file ? "has" : "have", found, run.summary.frames, is_one_file ? "it is" : "they are",
        found > 0 ? "damaged" : "missing or damaged"));
  }
}

RunData read_run(const std::string& directory, bool with_results) {
  if (!fs::is_directory(directory)) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: no such directory: name the output directories of runs", directory));
  }
  const auto path = [&](const char* file) { return (fs::path(directory) / file).string(); };
  RunData run;
  run.directory = directory;
  run.summary_json = summary_text_of_run(directory);
  run.summary = summary_from_json(run.summary_json, path("summary.json"));
  const bool may_grow = run.summary.status != "done";
  run.history = read_history(path("history.csv"), may_grow);
  check_rows(path("history.csv"), run.history);
  for (const std::string& file : probe_files(directory)) {
    run.probe_tables.emplace_back(file, read_history(path(file.c_str()), may_grow));
    check_rows(path(file.c_str()), run.probe_tables.back().second);
  }
  if (const auto step = run.history.columns.find("step"); step != run.history.columns.end()) {
    const auto last = long(step->second.back());
    if (run.summary.status == "done" && last < run.summary.steps)
      run.notes.push_back(fmt::format("history.csv ends at step {} of {}: it is truncated", last, run.summary.steps));
  }
  if (with_results) read_results(run);
  return run;
}

fs::path whole_path(const std::string& directory) {
  fs::path path = fs::absolute(directory).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // a trailing slash
  return path;
}

std::vector<std::string> parts_of(const fs::path& path) {
  std::vector<std::string> parts;
  for (const fs::path& part : path) parts.push_back(part.string());
  return parts;
}

/// Returns the number of leading parts that all paths have in common.
std::size_t common_parts(const std::vector<std::vector<std::string>>& paths) {
  std::size_t count = paths.front().size();
  for (const auto& path : paths) {
    const auto ends = std::mismatch(path.begin(), path.end(), paths.front().begin(), paths.front().end());
    count = std::min(count, std::size_t(ends.first - path.begin()));
  }
  return count;
}

/// Names the runs by their paths without the common part.
void name_runs(std::vector<RunData>& runs) {
  std::vector<std::vector<std::string>> paths;
  for (const RunData& run : runs) paths.push_back(parts_of(whole_path(run.directory)));
  const std::size_t common = runs.size() == 1 ? paths.front().size() - 1 : common_parts(paths);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    // A directory that contains the others keeps its own name.
    for (std::size_t k = std::min(common, paths[i].size() - 1); k < paths[i].size(); ++k)
      runs[i].name += (runs[i].name.empty() ? "" : "/") + paths[i][k];
  }
}

}  // namespace

const HistoryTable* RunData::table_of(const std::string& column_name) const {
  if (history.columns.contains(column_name)) return &history;
  for (const auto& [file, table] : probe_tables) {
    if (table.columns.contains(column_name)) return &table;
  }
  return nullptr;
}

const HistoryTable& RunData::require_table_of(const std::string& column_name) const {
  if (const HistoryTable* const table = table_of(column_name)) return *table;
  std::string files = "history.csv";
  for (const auto& [file, table] : probe_tables) files += ", " + file;
  throw Error(ErrorKind::invalid_input,
              fmt::format("{}: there is no column \"{}\" in {}", directory, column_name, files));
}

const std::vector<double>& RunData::column(const std::string& column_name) const {
  return require_table_of(column_name).columns.at(column_name);
}

const std::vector<double>& RunData::times_of(const std::string& column_name) const {
  return require_table_of(column_name).columns.at("time");
}

std::vector<std::string> RunData::column_names() const {
  std::vector<std::string> names = history.names;
  for (const auto& entry : probe_tables) {
    for (const std::string& name : entry.second.names) {
      // Steps and times are in every table.
      if (table_of(name) == &entry.second) names.push_back(name);
    }
  }
  return names;
}

const Probe* RunData::contact_probe() const {
  const auto found = std::ranges::find_if(summary.probes, [this](const auto& each) {
    return each.probe.contact_node >= 0 && has_column(each.probe.name + ".reaction_normal");
  });
  return found == summary.probes.end() ? nullptr : &found->probe;
}

std::vector<RunData> read_runs(const std::vector<std::string>& directories, bool with_results) {
  std::vector<RunData> runs;
  std::set<fs::path> visited;
  for (const std::string& directory : directories) {
    if (!visited.insert(whole_path(directory)).second)
      throw Error(ErrorKind::usage, fmt::format("{}: this directory is named twice", directory));
    runs.push_back(read_run(directory, with_results));
  }
  name_runs(runs);
  return runs;
}

std::string common_folder(const std::vector<std::string>& directories) {
  if (directories.size() == 1) return directories.front();
  std::vector<std::vector<std::string>> paths;
  for (const std::string& directory : directories) paths.push_back(parts_of(whole_path(directory)));
  if (common_parts(paths) < 2) return ".";  // at most "/"
  fs::path folder;
  for (std::size_t k = 0; k < common_parts(paths); ++k) folder /= paths.front()[k];
  return folder.lexically_proximate(fs::current_path()).string();
}

}  // namespace ricochet
