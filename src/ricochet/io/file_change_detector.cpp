#include "ricochet/io/file_change_detector.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

FileChangeDetector::FileChangeDetector(std::string path) : path_(std::move(path)) {
  struct stat file {};
  if (stat(path_.c_str(), &file) != 0) throw_file_error(path_, "access", errno);
  device_ = file.st_dev;
  number_ = file.st_ino;
  size_ = file.st_size;
}

void FileChangeDetector::expect_present_size() {
  struct stat file {};
  if (stat(path_.c_str(), &file) != 0) throw_file_error(path_, "access", errno);
  if (file.st_size < size_)
    refuse(fmt::format("has {} bytes, but this run has written {}", std::int64_t(file.st_size), size_));
  if (knows_end_ && ends_with_zeros()) refuse("has zeros in place of data that this run has written");
  size_ = file.st_size;
  knows_end_ = !ends_with_zeros();
}

/// Inspects the last bytes of the file as it was when it had the expected size.
bool FileChangeDetector::ends_with_zeros() const {
  std::array<char, 512> end{};
  std::ifstream file(path_, std::ios::binary);
  file.seekg(std::max<std::int64_t>(size_ - std::int64_t(end.size()), 0));
  file.read(end.data(), end.size());
  return std::ranges::all_of(end, [](char c) { return c == '\0'; });
}

void FileChangeDetector::require_unchanged() const {
  struct stat file {};
  if (stat(path_.c_str(), &file) != 0) {
    if (errno == ENOENT) refuse("no longer exists");
    throw_file_error(path_, "access", errno);
  }
  if (file.st_dev != device_ || file.st_ino != number_) refuse("is not the file that this run has been writing");
  if (file.st_size != size_)
    refuse(fmt::format("has {} bytes, but this run has written {}", std::int64_t(file.st_size), size_));
}

void FileChangeDetector::refuse(const std::string& state) const {
  throw Error(ErrorKind::file_access, fmt::format("{}: {}: another program has changed it during the run; restore the "
                                                  "file and continue with --resume, or start anew with --force",
                                                  path_, state));
}

}  // namespace ricochet
