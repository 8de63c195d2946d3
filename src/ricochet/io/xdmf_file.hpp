#pragma once

#include <fstream>
#include <optional>
#include <string>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/file_change_detector.hpp"
#include "ricochet/io/line_checksums.hpp"

/// @file XDMF 3.0 side-file: a temporal collection of grids, a complete document after each of them.
namespace ricochet {

class XdmfFile {
 public:
  /// Creates a file with a collection of this name. `included`: another such file, in the same directory, whose
  /// collection is displayed with this one; may be empty. Throws Error(file_access).
  XdmfFile(std::string path, const std::string& collection, const std::string& included = "");
  /// Continues after the grids that existed when save() was called. Throws Error(file_access) if it is not that file.
  XdmfFile(std::string path, const SnapshotVisitor& saved);
  void save(const SnapshotVisitor& visit);

  /// Appends a `Grid` element. Throws Error(file_access), also if another program has changed the file.
  void append(const std::string& grid);
  void require_unchanged() const { change_detector_->require_unchanged(); }

 private:
  std::string path_;
  std::fstream file_;
  std::optional<FileChangeDetector> change_detector_;
  LineChecksums checksums_;  ///< without the closing tags
};

}  // namespace ricochet
