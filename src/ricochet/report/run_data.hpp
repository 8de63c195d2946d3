#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/io/history_file.hpp"
#include "ricochet/io/results_reader.hpp"
#include "ricochet/io/summary.hpp"

/// @file What a run has left in its directory, read back to be looked at.
namespace ricochet {

struct RunData {
  std::string directory;
  std::string name;  ///< what tells it from the other runs: the part of the path that is its own
  std::string summary_json;
  RunSummary summary;
  HistoryTable history;
  std::vector<std::pair<std::string, HistoryTable>> probe_tables;  ///< by file: probes with rows of their own
  std::unique_ptr<ResultsReader> results;                          ///< nullptr: the run wrote no fields
  std::vector<ObstacleFrame> obstacles;                            ///< of each frame; empty: none
  std::vector<std::string> notes;  ///< what is missing in its files, although the summary speaks of it

  /// Values of a column of the history, or of probes with rows of their own. Throws Error(invalid_input) where it is
  /// missing.
  [[nodiscard]] const std::vector<double>& column(const std::string& column_name) const;
  [[nodiscard]] bool has_column(const std::string& column_name) const { return table_of(column_name) != nullptr; }
  /// The times of a column's rows.
  [[nodiscard]] const std::vector<double>& times_of(const std::string& column_name) const;
  [[nodiscard]] std::vector<std::string> column_names() const;
  /// The first of the probes that is a node on the contact boundary; nullptr: there is none.
  [[nodiscard]] const Probe* contact_probe() const;

 private:
  /// nullptr: no table has this column.
  [[nodiscard]] const HistoryTable* table_of(const std::string& column_name) const;
};

/// Runs that go on, were interrupted or have failed are read as far as they are. Throws Error(file_access) where there
/// is no run, Error(invalid_input) where its files are damaged, Error(usage) where a directory is named twice.
/// `with_results`: also the fields, where there are some.
[[nodiscard]] std::vector<RunData> read_runs(const std::vector<std::string>& directories, bool with_results);

/// The folder that all of these are in: of one directory, itself; "." where they have nothing in common.
[[nodiscard]] std::string common_folder(const std::vector<std::string>& directories);

}  // namespace ricochet
