#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/io/history_file.hpp"
#include "ricochet/io/results_reader.hpp"
#include "ricochet/io/summary.hpp"

/// @file Results of a run, read back from its directory.
namespace ricochet {

struct RunData {
  std::string directory;
  std::string name;  ///< the path without the folders that all runs have in common
  std::string summary_json;
  RunSummary summary;
  HistoryTable history;
  std::vector<std::pair<std::string, HistoryTable>> probe_tables;  ///< by file: probes with rows of their own
  std::unique_ptr<ResultsReader> results;                          ///< null without frames, and if not read
  std::vector<ObstacleFrame> obstacles;                            ///< per frame; empty if none
  std::vector<std::string> notes;  ///< data that the summary mentions but the files lack

  /// Returns the values of a column of the history, or of a probe with rows of its own. Throws Error(invalid_input) if
  /// it is missing.
  [[nodiscard]] const std::vector<double>& column(const std::string& column_name) const;
  [[nodiscard]] bool has_column(const std::string& column_name) const { return table_of(column_name) != nullptr; }
  /// Returns the times of a column's rows. Throws as column() does.
  [[nodiscard]] const std::vector<double>& times_of(const std::string& column_name) const;
  /// Returns all names of columns, each once.
  [[nodiscard]] std::vector<std::string> column_names() const;
  /// Returns the first probe that is a node on the contact boundary and has a column of its reaction; null if none.
  [[nodiscard]] const Probe* contact_probe() const;

 private:
  /// Returns null if no table has this column.
  [[nodiscard]] const HistoryTable* table_of(const std::string& column_name) const;
  [[nodiscard]] const HistoryTable& require_table_of(const std::string& column_name) const;
};

/// Reads runs; those that are in progress, were interrupted or have failed are read as far as they exist. Throws
/// Error(file_access) if there is no run, Error(invalid_input) if its files are damaged, Error(usage) if a directory is
/// named twice. `with_results`: also reads the fields, if there are any.
[[nodiscard]] std::vector<RunData> read_runs(const std::vector<std::string>& directories, bool with_results);

/// Returns the folder that contains all of these: for a single directory, itself; "." if they have nothing in common.
[[nodiscard]] std::string common_folder(const std::vector<std::string>& directories);

}  // namespace ricochet
