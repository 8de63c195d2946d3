#include "ricochet/io/durable_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <fstream>
#include <iterator>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "ricochet/base/error.hpp"
#include "ricochet/base/input_file.hpp"

namespace ricochet {

namespace {

/// File descriptor that is closed at the end of its scope.
class OpenFile {
 public:
  OpenFile(const std::string& path, int flags) : OpenFile(path, flags, path) {}
  /// `known_as`: the name by which the user knows the file.
  OpenFile(const std::string& path, int flags, const std::string& known_as)
      : path_(known_as), descriptor_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) throw_file_error(path_, "open", errno);
  }
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  void sync() const {
    // File systems that cannot sync a directory report EINVAL: then there is nothing to wait for.
    if (fsync(descriptor_) != 0 && errno != EINVAL) throw_file_error(path_, "write to the disk", errno);
  }
  void close() {
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) != 0) throw_file_error(path_, "write", errno);
  }

 private:
  std::string path_;
  int descriptor_;
};

std::string parent_of(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

/// Other problems are reported when the file is opened.
void require_parent_directory(const std::string& path) {
  const std::string parent = parent_of(path);
  std::error_code ignored;
  using Type = std::filesystem::file_type;
  const Type type = std::filesystem::status(parent, ignored).type();
  if (type == Type::directory || type == Type::none || type == Type::unknown) return;
  throw Error(
      ErrorKind::file_access,
      fmt::format("{}: cannot write: {} {}", path, parent,
                  type == Type::not_found ? "does not exist; create this directory first" : "is not a directory"));
}

void write_all(const std::string& path, int descriptor, const std::string& content) {
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t written = write(descriptor, content.data() + done, content.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_file_error(path, "write", errno);
    done += std::size_t(written);
  }
}

}  // namespace

void throw_file_error(const std::string& path, const char* what, int error_number) {
  throw Error(ErrorKind::file_access, fmt::format("{}: cannot {}: {}", path, what, std::strerror(error_number)));
}

void sync_to_disk(const std::string& path) { OpenFile(path, O_RDONLY).sync(); }

void write_durably(const std::string& path, const std::string& content) {
  require_parent_directory(path);
  const std::string temporary = path + ".new";
  try {
    OpenFile file(temporary, O_WRONLY | O_CREAT | O_TRUNC, path);
    write_all(path, file.descriptor(), content);
    file.sync();
    file.close();
    if (std::rename(temporary.c_str(), path.c_str()) != 0) throw_file_error(path, "move into place", errno);
    sync_to_disk(parent_of(path));
  } catch (const Error&) {
    unlink(temporary.c_str());
    throw;
  }
}

std::string read_file(const std::string& path) {
  if (const std::string why = unreadable_reason(path); !why.empty())
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot read: {}", path, why));
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw_file_error(path, "read", errno);
  return {std::istreambuf_iterator<char>(file), {}};
}

void require_length(const std::string& path, std::int64_t length) {
  const auto refuse = [&](const std::string& state) {
    throw Error(ErrorKind::file_access, fmt::format("{}: {}, but had {} bytes when the checkpoint was written: it has "
                                                    "changed since; restore it, or start anew with --force",
                                                    path, state, length));
  };
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) {
    if (errno == ENOENT) refuse("is missing");
    throw_file_error(path, "access", errno);
  }
  if (about.st_size < length) refuse(fmt::format("has {} bytes", about.st_size));
}

void truncate_file(const std::string& path, std::int64_t length) {
  require_length(path, length);
  const OpenFile file(path, O_WRONLY);
  if (ftruncate(file.descriptor(), length) != 0) throw_file_error(path, "truncate", errno);
}

void reserve_space(const std::string& path, std::int64_t bytes) {
  const OpenFile file(path, O_WRONLY);
  struct stat about {};
  if (fstat(file.descriptor(), &about) != 0) throw_file_error(path, "access", errno);
  // Reservation ignores the process limit (ulimit -f), so it is checked here.
  struct rlimit limit {};
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      static_cast<rlim_t>(about.st_size + bytes) > limit.rlim_cur)
    throw_file_error(path, "write", EFBIG);
  if (fallocate(file.descriptor(), FALLOC_FL_KEEP_SIZE, about.st_size, bytes) == 0) return;
  const int problem = errno;
  // Other errors only mean that this file system does not support reservation.
  if (problem == ENOSPC || problem == EDQUOT || problem == EFBIG) throw_file_error(path, "write", problem);
}

}  // namespace ricochet
