#pragma once

#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/file_change_detector.hpp"
#include "ricochet/io/line_checksums.hpp"

/// @file history.csv and probes-N.csv: a header, then a row every so many steps, numbers as %.17g, never an empty
/// field.
namespace ricochet {

/// Writes a history row by row. Every function that writes throws Error(file_access) if the file cannot be written, or
/// if another program has changed it.
class HistoryWriter {
 public:
  /// Begins a new file; with `saved`, continues after the rows that existed when save() was called. Throws
  /// Error(file_access) if that file is missing or shorter; require_same_files() compares its content.
  HistoryWriter(const std::string& path, const std::vector<std::string>& columns,
                const std::optional<SnapshotVisitor>& saved = {});
  /// Writes the buffered rest, if possible.
  ~HistoryWriter();
  HistoryWriter(const HistoryWriter&) = delete;
  HistoryWriter& operator=(const HistoryWriter&) = delete;
  /// Saves the state after the last row; a snapshot of it is valid for the file only after sync().
  void save(const SnapshotVisitor& visit);
  void write(const std::vector<double>& row);
  /// Writes everything to the operating system, so that others can read it. Checks the file even if nothing is
  /// buffered.
  void flush();
  /// Flushes, and waits until everything is on the disk.
  void sync();

 private:
  void put_line();

  std::string path_;
  std::ofstream file_;
  std::optional<FileChangeDetector> change_detector_;
  std::string line_, waiting_;  ///< `waiting_`: buffered lines
  LineChecksums checksums_;
};

/// History that was read back, by columns.
struct HistoryTable {
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
};

/// Step of the last complete row of a file that may still be written to; 0 without rows.
[[nodiscard]] long last_history_step(const std::string& path);

/// Reads a history. `may_grow`: for a run in progress or stopped, whose last row is ignored if no end of line follows
/// it; otherwise such a row counts. Throws Error(file_access) or Error(invalid_input) with the line.
[[nodiscard]] HistoryTable read_history(const std::string& path, bool may_grow = false);

}  // namespace ricochet
