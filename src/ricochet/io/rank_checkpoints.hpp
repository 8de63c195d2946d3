#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/checkpoint.hpp"

/// @file Checkpoints of a run on several ranks: a file per rank, and a manifest that confirms that all are complete.
///
/// The run's directory contains ranks/NNNN/checkpoint-SSSSSSSSS.ckpt, those of rank NNNN (checkpoint.hpp), and
/// ranks/checkpoint-SSSSSSSSS.manifest, a text that names them:
///   ricochet checkpoint
///   ranks 4
///   step 120
///   0000 1f3870be        the CRC-32 at the end of each file
namespace ricochet {

/// Writes a checkpoint, which is on the disk on return, on all ranks; keeps the last two. Throws Error(file_access) on
/// all.
void write_rank_checkpoint(const Ranks& ranks, const std::string& directory, long step, const Snapshot& snapshot);

/// This rank's part of the newest checkpoint that all ranks can read and whose files all match its manifest; nullopt if
/// there is none. The first rank warns of those that cannot be used.
[[nodiscard]] std::optional<Snapshot> newest_rank_checkpoint(const Ranks& ranks, const std::string& directory);

/// Number of ranks of the run in this directory, by its newest manifest; 0 if there is none.
[[nodiscard]] int ranks_of_checkpoints(const std::string& directory);

/// Returns whether checkpoints were written, readable or not.
[[nodiscard]] bool has_rank_checkpoints(const std::string& directory);

/// Command that runs a case on so many processes: "ricochet run", "mpirun -n 4 ricochet-mpi run".
[[nodiscard]] std::string run_command(int processes);

/// Throws Error(invalid_input) if the number of ranks of the checkpoints differs: only as many can combine the parts.
void require_ranks_of_checkpoints(const std::string& directory, int ranks);

/// Directory of the first rank's checkpoints, which contain the case and its settings.
[[nodiscard]] std::string checkpoint_folder_of_first_rank(const std::string& directory);

/// Newest step of which all ranks have a checkpoint, and its manifest; nullopt if there is none.
[[nodiscard]] std::optional<CheckpointFile> newest_manifest(const std::string& directory);

/// Manifests and checkpoints of steps after this one; for step −1 all, with the folders.
[[nodiscard]] std::vector<std::string> rank_checkpoint_files(const std::string& directory, long after_step);

}  // namespace ricochet
