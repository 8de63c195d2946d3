#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"

/// @file Checkpoints: snapshots in files checkpoint-SSSSSSSSS.ckpt of a run's directory, of which the last two are
/// kept.
///
/// A file holds, little-endian: "RICOCHET", the number of the format (32 bits), the length of the following values (64
/// bits), the values, and the CRC-32 of everything before it. A value is its name (length, 32 bits, and bytes), its
/// kind (8 bits: 0 reals of 64 bits, 1 integers of 64 bits, 2 texts), its number of entries (64 bits) and the entries;
/// a text is its length (32 bits) and bytes.
namespace ricochet {

struct CheckpointFile {
  std::string path;
  long step = 0;
};

/// Checkpoints in a directory, oldest first.
[[nodiscard]] std::vector<CheckpointFile> checkpoint_files(const std::string& directory);

/// Writes a checkpoint, which is on the disk when the function returns; then removes all but the last two. Throws
/// Error(file_access), after which the earlier ones still exist.
void write_checkpoint(const std::string& directory, long step, const Snapshot& snapshot);

/// Throws Error(file_access), or Error(invalid_input) which names the damage of the file.
[[nodiscard]] Snapshot read_checkpoint(const std::string& path);

/// Newest readable checkpoint; nullopt if there is none. A warning names every damaged one. Throws VersionError if one
/// is of a version whose results are not read.
[[nodiscard]] std::optional<Snapshot> newest_checkpoint(const std::string& directory);

/// Content of a file, and its inverse: decode_snapshot throws Error(invalid_input) for anything that encode_snapshot
/// does not produce, and allocates no more than a few times the size of the text.
[[nodiscard]] std::string encode_snapshot(const Snapshot& snapshot);
[[nodiscard]] Snapshot decode_snapshot(const std::string& text);

}  // namespace ricochet
