#include "ricochet/io/run_directory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/failure_bundle.hpp"
#include "ricochet/io/rank_checkpoints.hpp"
#include "ricochet/io/results_format.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

int open_directory(const std::string& path) { return open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }

}  // namespace

RunDirectory::RunDirectory(std::string path, const Ranks& ranks) : path_(std::move(path)) {
  ranks.run_collectively([&] {
    if (ranks.is_first()) reserve();
  });
}

void RunDirectory::reserve() {
  std::error_code problem;
  at_interruption_.emplace([&] { is_new_ = fs::create_directories(path_, problem); },
                           [this] {
                             if (is_new_) rmdir(path_.c_str());  // fails unless it is empty
                           });
  if (problem || !fs::is_directory(path_, problem)) {
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot create this directory: {}", path_,
                                                    problem ? problem.message() : "a file of that name exists"));
  }
  if (access(path_.c_str(), W_OK | X_OK) != 0) throw_file_error(path_, "write into this directory", errno);
  lock_ = open_directory(path_);
  if (lock_ < 0) throw_file_error(path_, "read this directory", errno);
  // A process that only tests whether a run is in progress holds the lock for a moment.
  for (int attempt = 0; attempt < 20; ++attempt) {
    if (flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
    if (errno != EWOULDBLOCK) {
      log::info(fmt::format("{}: cannot be locked ({}): make sure that no other run writes into it", path_,
                            std::strerror(errno)));
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  close(lock_);
  throw Error(
      ErrorKind::file_access,
      fmt::format("{}: another run is writing into this directory; choose another directory with -o, or stop that run",
                  path_));
}

RunDirectory::~RunDirectory() {
  std::error_code not_empty;
  if (is_new_) fs::remove(path_, not_empty);
  if (lock_ >= 0) close(lock_);
}

std::string RunDirectory::file(const std::string& name) const { return (fs::path(path_) / name).string(); }

std::vector<std::string> RunDirectory::results() const {
  std::vector<std::string> names = files_of_all_formats(), result;
  names.insert(names.begin(), {"history.csv", "summary.json"});
  for (const std::string& name : names) {
    if (fs::exists(file(name))) result.push_back(file(name));
  }
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, problem)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("probes-") && name.ends_with(".csv")) result.push_back(entry.path().string());
  }
  return result;
}

std::vector<std::string> RunDirectory::leftover_files(long step) const {
  std::vector<std::string> names{"summary.json.new"}, result;
  for (const std::string& name : files_of_all_formats()) names.push_back(name + ".pattern");
  for (const std::string& name : names) {
    if (fs::exists(file(name))) result.push_back(file(name));
  }
  for (const std::string& failure : failure_files(path_)) result.push_back(failure);
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, problem)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("checkpoint-") && name.ends_with(".ckpt.new")) result.push_back(entry.path().string());
  }
  for (const CheckpointFile& checkpoint : checkpoint_files(path_)) {
    if (checkpoint.step > step) result.push_back(checkpoint.path);
  }
  for (const std::string& file : rank_checkpoint_files(path_, step)) result.push_back(file);
  return result;
}

bool RunDirectory::is_in_use(const std::string& path) {
  const int directory = open_directory(path);
  if (directory < 0) return false;
  const bool locked = flock(directory, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(directory);
  return locked;
}

bool holds_run(const std::string& directory) {
  std::error_code ignored;
  return fs::exists(fs::path(directory) / "summary.json", ignored) ||
         (fs::is_directory(directory, ignored) &&
          (!checkpoint_files(directory).empty() || ranks_of_checkpoints(directory) > 0));
}

void remove_files(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    std::error_code problem;
    fs::remove(file, problem);
    if (problem) throw Error(ErrorKind::file_access, fmt::format("{}: cannot be removed: {}", file, problem.message()));
  }
}

}  // namespace ricochet
