#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/base/snapshot.hpp"

/// @file Checkpoints of a run on several ranks: a file of each, and a manifest that says when all are there.
///
/// In the run's directory ranks/NNNN/checkpoint-SSSSSSSSS.ckpt are those of rank NNNN (checkpoint.hpp), and
/// ranks/checkpoint-SSSSSSSSS.manifest, a text, names them:
///   ricochet checkpoint
///   ranks 4
///   step 120
///   0000 1f3870be        the CRC-32 at the end of each file
namespace ricochet {

/// On the disk when it returns, on all ranks; the last two are kept. Throws Error(file_access) on all.
void write_rank_checkpoint(const Ranks& ranks, const std::string& directory, long step, const Snapshot& snapshot);

/// This rank's part of the newest one that all ranks can read and of which all files are those of its manifest. The
/// first rank warns of what cannot be used. None: there is none.
[[nodiscard]] std::optional<Snapshot> newest_rank_checkpoint(const Ranks& ranks, const std::string& directory);

/// The number of ranks of the run in this directory, by its newest manifest; 0: there is none.
[[nodiscard]] int ranks_of_checkpoints(const std::string& directory);

/// Whether some were written, that can be read or not.
[[nodiscard]] bool has_rank_checkpoints(const std::string& directory);

/// What runs a case by so many: "ricochet run", "mpirun -n 4 ricochet-mpi run".
[[nodiscard]] std::string run_command(int processes);

/// Throws Error(invalid_input) where that is another number than this: only as many put the parts together.
void require_ranks_of_checkpoints(const std::string& directory, int ranks);

/// Where the first rank has its checkpoints, which know the case and its settings.
[[nodiscard]] std::string checkpoint_folder_of_first_rank(const std::string& directory);

/// The newest step of which all ranks have a checkpoint, and its manifest. None: there is none.
[[nodiscard]] std::optional<CheckpointFile> newest_manifest(const std::string& directory);

/// Manifests and checkpoints of steps after this one; of step −1 all, and the folders.
[[nodiscard]] std::vector<std::string> rank_checkpoint_files(const std::string& directory, long after_step);

}  // namespace ricochet
