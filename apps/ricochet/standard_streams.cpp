#include "standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "ricochet/base/error.hpp"

namespace ricochet::program {

namespace {

bool output_was_closed = false;

}  // namespace

void open_closed_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    if (descriptor == STDOUT_FILENO) output_was_closed = true;
    // The lowest free descriptor is this one, as those below are open.
    if (open("/dev/null", O_RDWR) != descriptor) _exit(static_cast<int>(ErrorKind::file_access));
  }
}

void require_standard_output() {
  if (output_was_closed) {
    throw Error(
        ErrorKind::file_access,
        "standard output is closed, and this command writes its result there; redirect it to a file or a terminal");
  }
}

void flush_standard_output() {
  const int before = errno;  // error of output that was written before
  errno = 0;
  std::fflush(stdout);
  const int problem = errno != 0 ? errno : before;
  if (!standard_output_failed()) return;
  throw Error(ErrorKind::file_access, fmt::format("standard output: cannot write: {}; the printed text is incomplete "
                                                  "(the files that the command writes are complete)",
                                                  std::strerror(problem)));
}

bool standard_output_failed() {
  return std::ferror(stdout) != 0;
}

}  // namespace ricochet::program
