#include "process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/base/blas.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet::program {

namespace {

bool output_was_closed = false;

}  // namespace

void restart_without_blas_threads(char** argv) {
  const char* const threads = std::getenv("OPENBLAS_NUM_THREADS");
  if (!memory_is_limited() || (threads != nullptr && std::string_view(threads) == "1")) return;
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  execv("/proc/self/exe", argv);
}

void keep_memory() {
#ifdef __GLIBC__
  constexpr int threshold = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, threshold);
  mallopt(M_TRIM_THRESHOLD, threshold);
#endif
}

void open_closed_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    if (descriptor == STDOUT_FILENO) output_was_closed = true;
    // The lowest free descriptor is this one, as those below are open.
    if (open("/dev/null", O_RDWR) != descriptor) _exit(int(ErrorKind::file_access));
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

bool standard_output_failed() { return std::ferror(stdout) != 0; }

void refuse_empty_values(CLI::App& app) {
  const CLI::Validator given([](const std::string& value) { return value.empty() ? "the value is empty" : ""; }, "");
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0 && option->get_type_name() != "TEXT") option->check(given);
    }
  }
}

void refuse_unknown_command(CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  if (word.empty() || word.starts_with('-') || std::ranges::find(names, word) != names.end()) return;
  if (word.ends_with(".toml")) {
    throw Error(ErrorKind::usage,
                fmt::format("a command is missing: write `ricochet run {0}`, or one of the commands that "
                            "`ricochet --help` lists",
                            word));
  }
  const std::string near = nearest_name(word, names);
  throw Error(ErrorKind::usage, fmt::format("there is no command \"{}\"; {}", word,
                                            near.empty() ? "the commands are " + join_names(names)
                                                         : fmt::format("did you mean \"{}\"?", near)));
}

}  // namespace ricochet::program
