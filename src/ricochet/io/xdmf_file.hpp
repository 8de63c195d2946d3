#pragma once

#include <fstream>
#include <string>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/line_checksums.hpp"

/// @file The XDMF 3.0 side-file: a temporal collection of grids, a complete document after every one of them.
namespace ricochet {

class XdmfFile {
 public:
  /// A new file of a collection of this name. `included`: another such file, beside it, whose collection is shown with
  /// this one; empty: none. Throws Error(file_access).
  XdmfFile(std::string path, const std::string& collection, const std::string& included = "");
  /// Goes on after the grids that were there when save() was called. Throws Error(file_access) where it is not that
  /// file.
  XdmfFile(std::string path, const Snapshot& snapshot, const std::string& name);
  void save(Snapshot& snapshot, const std::string& name) const;

  /// Appends a <Grid> element.
  void append(const std::string& grid);

 private:
  std::string path_;
  std::fstream file_;
  LineChecksums checksums_;  ///< without the closing tags
};

}  // namespace ricochet
