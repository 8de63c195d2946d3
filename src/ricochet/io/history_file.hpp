#pragma once

#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/line_checksums.hpp"
#include "ricochet/io/sole_writer.hpp"

/// @file history.csv: a header row, then one row per step, numbers as %.17g, never an empty field.
namespace ricochet {

class HistoryWriter {
 public:
  /// Throws Error(file_access) when the file cannot be opened or written (then or later), or another program has
  /// changed it before a piece is written.
  HistoryWriter(const std::string& path, const std::vector<std::string>& columns);
  /// Goes on after the rows that were there when save() was called. Throws Error(file_access) where it is not that
  /// file.
  HistoryWriter(const std::string& path, const Snapshot& snapshot, const std::string& name);
  /// Hands over what is left, where that is possible.
  ~HistoryWriter();
  HistoryWriter(const HistoryWriter&) = delete;
  HistoryWriter& operator=(const HistoryWriter&) = delete;
  /// Of what has been flushed.
  void save(Snapshot& snapshot, const std::string& name) const;
  void write(const std::vector<double>& row);
  /// Hands everything to the operating system, so that others can read along. Where nothing is left to be handed over
  /// the file is looked at all the same.
  void flush();
  /// Flushes, and waits until everything is on the disk.
  void sync();

 private:
  void open();
  void put_line();

  std::string path_;
  std::ofstream file_;
  std::optional<SoleWriter> sole_;
  std::string line_, waiting_;  ///< waiting: lines that have not been handed over
  LineChecksums checksums_;
};

/// A history read back, column by column.
struct HistoryTable {
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> columns;
};

/// Step of the last row that is complete, of a file that may still be written to; 0 without rows.
[[nodiscard]] long last_history_step(const std::string& path);

/// `may_grow`: of a run that goes on or was stopped, whose last row may not be complete and is left out then. Throws
/// Error(file_access) or Error(invalid_input) with the line.
[[nodiscard]] HistoryTable read_history(const std::string& path, bool may_grow = false);

}  // namespace ricochet
