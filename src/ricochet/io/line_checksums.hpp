#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/snapshot.hpp"

/// @file Checksums of a text file, computed as it is written, to verify its content when a run is resumed.
namespace ricochet {

/// Checksums of blocks of pieces (mostly lines). A file of a few hundred pieces has one checksum per piece; with more
/// pieces the blocks grow, so that nothing is allocated.
class LineChecksums {
 public:
  LineChecksums();
  /// Loads saved checksums.
  explicit LineChecksums(const SnapshotVisitor& saved) : LineChecksums() { persist(saved, ""); }
  /// Saves the checksums and the name of the file, which require_same_files() reads; loads the checksums.
  void persist(const SnapshotVisitor& visit, std::string file_name);

  /// Adds a piece that has been appended to the file.
  void add(std::string_view piece);
  [[nodiscard]] std::int64_t length() const { return length_; }
  /// Throws Error(file_access) if the file does not begin with the added pieces.
  void require_same(const std::string& path) const;

 private:
  void merge_blocks();

  struct Block {
    std::uint32_t sum = 0;
    std::int64_t length = 0;
  };
  std::vector<Block> blocks_;  ///< the last one may be incomplete
  std::int64_t pieces_ = 0, pieces_per_block_ = 1, length_ = 0;
};

/// Compares the files of a directory with all checksums in a snapshot; later additions to the files are ignored. Throws
/// Error(file_access), which names the first file that is missing, shorter or different, and the lines.
void require_same_files(const std::string& directory, const Snapshot& snapshot);

}  // namespace ricochet
