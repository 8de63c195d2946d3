#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"

/// @file Checkpoints: snapshots in files checkpoint-SSSSSSSSS.ckpt of a run's directory, the last two of them.
///
/// A file holds, little-endian: "RICOCHET", the format's number (32 bits), the length of what follows (64 bits), the
/// values, and the CRC-32 of everything before it. A value is its name (length, 32 bits, and bytes), its kind (8 bits:
/// 0 reals of 64 bits, 1 whole numbers of 64 bits, 2 texts), their count (64 bits) and they themselves, a text as its
/// length (32 bits) and bytes.
namespace ricochet {

struct CheckpointFile {
  std::string path;
  long step = 0;
};

/// Those in a directory, oldest first.
[[nodiscard]] std::vector<CheckpointFile> checkpoint_files(const std::string& directory);

/// On the disk when it returns; then all but the last two are removed. Throws Error(file_access): those that were there
/// are there still.
void write_checkpoint(const std::string& directory, long step, const Snapshot& snapshot);

/// Throws Error(file_access), or Error(invalid_input) which says what of the file is damaged.
[[nodiscard]] Snapshot read_checkpoint(const std::string& path);

/// The newest that can be read. A warning names every one that is damaged. None: there is none, or all are damaged.
[[nodiscard]] std::optional<Snapshot> newest_checkpoint(const std::string& directory);

/// The content of a file, and back: throws Error(invalid_input) for anything that encode_snapshot does not make, and
/// allocates no more than a few times the size of the text.
[[nodiscard]] std::string encode_snapshot(const Snapshot& snapshot);
[[nodiscard]] Snapshot decode_snapshot(const std::string& text);

}  // namespace ricochet
