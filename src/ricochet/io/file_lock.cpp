#include "ricochet/io/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "ricochet/base/timer.hpp"

namespace ricochet {

FileLock::FileLock(const std::string& path) : file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}

FileLock::~FileLock() {
  if (file_ >= 0) close(file_);
}

bool FileLock::acquire(Kind kind, double seconds) {
  if (file_ < 0) return false;
  const int operation = (kind == Kind::shared ? LOCK_SH : LOCK_EX) | LOCK_NB;
  for (const Timer timer;;) {
    if (flock(file_, operation) == 0) return true;
    if ((errno != EWOULDBLOCK && errno != EINTR) || timer.seconds() > seconds) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

void FileLock::release() {
  if (file_ >= 0) flock(file_, LOCK_UN);
}

}  // namespace ricochet
