#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/base/checksum.hpp"
#include "ricochet/base/snapshot.hpp"

/// @file Checksums of a file of text, taken as it is written: is what a run has written still there when it goes on?
namespace ricochet {

/// Of blocks of pieces (lines, mostly). A file of a few hundred pieces has one checksum per piece; where there are more
/// the blocks grow, so that nothing is allocated.
class LineChecksums {
 public:
  LineChecksums();
  /// As saved.
  LineChecksums(const Snapshot& snapshot, const std::string& name);
  void save(Snapshot& snapshot, const std::string& name, const std::string& file_name) const;

  /// A piece that has been written behind the others.
  void add(std::string_view piece);
  [[nodiscard]] std::int64_t length() const { return length_; }
  /// Throws Error(file_access) where the file does not begin with what was added.
  void require_same(const std::string& path) const;

 private:
  void merge_blocks();

  struct Block {
    std::uint32_t sum = 0;
    std::int64_t length = 0;
  };
  std::vector<Block> blocks_;  ///< the last may not have all its pieces
  std::int64_t pieces_ = 0, pieces_per_block_ = 1, length_ = 0;
};

/// Compares the files of a directory with all checksums in a snapshot; what has been written after it does not count.
/// Throws Error(file_access) that names the first file that is missing, shorter or different, and the lines.
void require_same_files(const std::string& directory, const Snapshot& snapshot);

}  // namespace ricochet
