#include "ricochet/io/rank_checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t retained_manifests = 2;

struct Manifest {
  std::string path;
  long step = 0;
  std::vector<std::string> checksums;  ///< by rank; empty if unreadable
};

std::string folder_of(const std::string& directory) { return (fs::path(directory) / "ranks").string(); }

std::string folder_of_rank(const std::string& directory, int rank) {
  return (fs::path(folder_of(directory)) / fmt::format("{:04}", rank)).string();
}

std::string manifest_path(const std::string& directory, long step) {
  return (fs::path(folder_of(directory)) / fmt::format("checkpoint-{:09}.manifest", step)).string();
}

std::string checkpoint_path(const std::string& directory, int rank, long step) {
  return (fs::path(folder_of_rank(directory, rank)) / fmt::format("checkpoint-{:09}.ckpt", step)).string();
}

/// Returns the last four bytes of a checkpoint, the CRC-32 of everything before.
std::string checksum_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  unsigned char bytes[4] = {};
  if (!file || file.tellg() < 4 || !file.seekg(-4, std::ios::end) || !file.read(reinterpret_cast<char*>(bytes), 4))
    return "";
  return fmt::format("{:02x}{:02x}{:02x}{:02x}", bytes[3], bytes[2], bytes[1], bytes[0]);
}

std::string text_of(const Manifest& manifest) {
  std::string text = fmt::format("ricochet checkpoint\nranks {}\nstep {}\n", manifest.checksums.size(), manifest.step);
  for (std::size_t rank = 0; rank < manifest.checksums.size(); ++rank)
    text += fmt::format("{:04} {}\n", rank, manifest.checksums[rank]);
  return text;
}

Manifest read_manifest(const std::string& path, long step) {
  Manifest manifest{path, step, {}};
  std::ifstream file(path);
  std::string line;
  std::vector<std::string> lines;
  // A manifest has at most as many lines as there can be ranks.
  while (lines.size() < 1'000'000 && std::getline(file, line)) lines.push_back(line);
  if (lines.size() < 4) return manifest;
  for (std::size_t i = 3; i < lines.size(); ++i)
    manifest.checksums.push_back(lines[i].substr(std::min<std::size_t>(5, lines[i].size())));
  std::ostringstream rewritten;
  for (const std::string& each : lines) rewritten << each << '\n';
  if (rewritten.str() != text_of(manifest)) manifest.checksums.clear();
  return manifest;
}

/// Returns the manifests, newest first.
std::vector<Manifest> manifests(const std::string& directory) {
  std::vector<Manifest> result;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(directory), problem)) {
    const std::string name = entry.path().filename().string();
    const auto step = between(name, "checkpoint-", ".manifest");
    if (step && is_digits(*step, 9, 15))
      result.push_back(read_manifest(entry.path().string(), std::stol(std::string(*step))));
  }
  std::ranges::sort(result, [](const Manifest& a, const Manifest& b) { return a.step > b.step; });
  return result;
}

}  // namespace

void write_rank_checkpoint(const Ranks& ranks, const std::string& directory, long step, const Snapshot& snapshot) {
  std::string checksum;
  ranks.run_collectively([&] {
    std::error_code problem;
    const std::string own = folder_of_rank(directory, ranks.rank());
    fs::create_directories(own, problem);
    if (problem)
      throw Error(ErrorKind::file_access, fmt::format("{}: cannot create this directory: {}", own, problem.message()));
    write_checkpoint(own, step, snapshot);
    const std::string path = checkpoint_path(directory, ranks.rank(), step);
    checksum = checksum_of(path);
    if (checksum.empty()) throw Error(ErrorKind::file_access, path + ": cannot be read after it was written");
  });
  const std::vector<std::string> checksums = ranks.gather_texts(checksum);
  ranks.run_collectively([&] {
    if (!ranks.is_first()) return;
    const Manifest manifest{manifest_path(directory, step), step, checksums};
    write_durably(manifest.path, text_of(manifest));
    const std::vector<Manifest> all = manifests(directory);
    for (std::size_t i = retained_manifests; i < all.size(); ++i) {
      std::error_code problem;
      fs::remove(all[i].path, problem);
    }
  });
}

std::optional<Snapshot> newest_rank_checkpoint(const Ranks& ranks, const std::string& directory) {
  // The first rank's view of the folder counts: on a shared disk others may see an outdated one.
  Ranks::ForEach<std::int64_t> steps(static_cast<std::size_t>(ranks.size()));
  for (const Manifest& manifest : ranks.is_first() ? manifests(directory) : std::vector<Manifest>{}) {
    for (std::vector<std::int64_t>& to : steps) to.push_back(manifest.step);
  }
  const Ranks::ForEach<std::int64_t> received = ranks.exchange(std::move(steps));
  for (const std::int64_t step : received.front()) {
    const Manifest manifest = read_manifest(manifest_path(directory, step), step);
    std::optional<Snapshot> snapshot;
    std::string why = "the manifest is damaged, or belongs to another run";
    std::optional<VersionError> other_version;
    if (manifest.checksums.size() == std::size_t(ranks.size())) {
      const std::string path = checkpoint_path(directory, ranks.rank(), manifest.step);
      try {
        const std::string checksum = checksum_of(path);
        if (checksum.empty()) throw Error(ErrorKind::file_access, fmt::format("{}: it cannot be read", path));
        if (checksum != manifest.checksums[std::size_t(ranks.rank())])
          throw Error(ErrorKind::invalid_input,
                      fmt::format("{}: its checksum differs from that in the manifest", path));
        snapshot = read_checkpoint(path);
      } catch (const VersionError& problem) {
        other_version = problem;
      } catch (const Error& problem) {
        why = problem.what();
      }
    }
    ranks.run_collectively([&] {
      if (other_version) throw VersionError(*other_version);
    });
    if (!ranks.any(!snapshot)) return snapshot;
    std::vector<std::string> reasons = ranks.gather_texts(snapshot ? "" : why);
    reasons.erase(std::unique(reasons.begin(), reasons.end()), reasons.end());
    for (const std::string& reason : reasons) {
      if (!reason.empty()) log::warning(fmt::format("{}: this checkpoint cannot be used: {}", manifest.path, reason));
    }
  }
  return std::nullopt;
}

std::string checkpoint_folder_of_first_rank(const std::string& directory) { return folder_of_rank(directory, 0); }

std::optional<CheckpointFile> newest_manifest(const std::string& directory) {
  for (const Manifest& manifest : manifests(directory)) {
    if (!manifest.checksums.empty()) return CheckpointFile{manifest.path, manifest.step};
  }
  return {};
}

int ranks_of_checkpoints(const std::string& directory) {
  for (const Manifest& manifest : manifests(directory)) {
    if (!manifest.checksums.empty()) return int(manifest.checksums.size());
  }
  return 0;
}

bool has_rank_checkpoints(const std::string& directory) { return !manifests(directory).empty(); }

std::string run_command(int processes) {
  return processes == 1 ? "ricochet run" : fmt::format("mpirun -n {} ricochet-mpi run", processes);
}

void require_ranks_of_checkpoints(const std::string& directory, int ranks) {
  const int own = ranks_of_checkpoints(directory);
  if (own == 0 && ranks > 1 && !checkpoint_files(directory).empty())
    throw Error(ErrorKind::invalid_input,
                fmt::format("{0}: this is a run of one process; continue it with one: {1} --resume {0}", directory,
                            run_command(1)));
  if (own == 0 || own == ranks) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("{0}: this is a run of {1} processes; continue it with as many: {2} --resume {0}", directory,
                          own, run_command(own)));
}

std::vector<std::string> rank_checkpoint_files(const std::string& directory, long after_step) {
  std::vector<std::string> result, folders;
  for (const Manifest& manifest : manifests(directory)) {
    if (manifest.step > after_step) result.push_back(manifest.path);
  }
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(directory), problem)) {
    if (!entry.is_directory(problem) || !is_digits(entry.path().filename().string(), 4, 9)) continue;
    folders.push_back(entry.path().string());
    for (const CheckpointFile& file : checkpoint_files(entry.path().string())) {
      if (file.step > after_step) result.push_back(file.path);
    }
    for (const fs::directory_entry& file : fs::directory_iterator(entry.path(), problem)) {
      if (file.path().extension() == ".new") result.push_back(file.path().string());
    }
  }
  if (after_step >= 0) return result;
  result.insert(result.end(), folders.begin(), folders.end());
  if (fs::exists(folder_of(directory), problem)) result.push_back(folder_of(directory));
  return result;
}

}  // namespace ricochet
