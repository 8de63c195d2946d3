#include "ricochet/mesh/gmsh_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>

#include "ricochet/base/error.hpp"

extern char** environ;

namespace ricochet::gmsh {

namespace {

[[noreturn]] void fail_absent(const std::string& source) {
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("{}: the gmsh program is needed to mesh this file and is not installed; install it (apt-get install "
                  "gmsh), or convert the file to .msh on a machine that has it",
                  source));
}

/// The variables of this process, but without the user's own Gmsh options, on which the mesh should not depend.
std::vector<std::string> environment(const std::filesystem::path& workspace) {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!std::string_view(*variable).starts_with("GMSH_HOME=")) variables.emplace_back(*variable);
  }
  variables.push_back("GMSH_HOME=" + workspace.string());
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (std::string& string : strings) result.push_back(string.data());
  result.push_back(nullptr);
  return result;
}

struct Outcome {
  int spawn_error = 0;
  int status = 0;  ///< as waitpid gives it
};

/// Runs gmsh with what it says going to `log`. Arguments go to it as they are: no shell is involved.
Outcome run(std::vector<std::string> arguments, const std::filesystem::path& workspace,
            const std::filesystem::path& log) {
  arguments.insert(arguments.begin(), "gmsh");
  std::vector<std::string> variables = environment(workspace);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  Outcome outcome;
  pid_t child = 0;
  outcome.spawn_error =
      posix_spawnp(&child, "gmsh", &actions, nullptr, pointers(arguments).data(), pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (outcome.spawn_error != 0) return outcome;
  while (waitpid(child, &outcome.status, 0) < 0) {
    if (errno != EINTR) {
      outcome.spawn_error = errno;
      break;
    }
  }
  return outcome;
}

/// The last lines of what gmsh said, errors first in mind: warnings are dropped when there are errors.
std::string last_lines(const std::filesystem::path& log) {
  constexpr std::size_t limit = 6;
  std::deque<std::string> all;
  std::deque<std::string> errors;
  std::ifstream stream(log);
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) continue;
    for (auto* lines : {&all, &errors}) {
      if (lines == &errors && !line.starts_with("Error")) continue;
      lines->push_back(line);
      if (lines->size() > limit) lines->pop_front();
    }
  }
  std::string text;
  for (const std::string& line : errors.empty() ? all : errors) text += "\n  " + line;
  return text.empty() ? " (it said nothing)" : text;
}

std::string describe(const Outcome& outcome) {
  if (WIFSIGNALED(outcome.status)) return fmt::format("was killed by signal {}", WTERMSIG(outcome.status));
  return fmt::format("ended with status {}", WEXITSTATUS(outcome.status));
}

void check_spawned(const Outcome& outcome, const std::string& source) {
  const bool absent = WIFEXITED(outcome.status) && WEXITSTATUS(outcome.status) == 127;
  if (outcome.spawn_error == ENOENT || (outcome.spawn_error == 0 && absent)) fail_absent(source);
  if (outcome.spawn_error != 0) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: the gmsh program, needed to mesh this file, cannot be run: {}", source,
                            std::strerror(outcome.spawn_error)));
  }
}

}  // namespace

std::string program_version(const std::string& source) {
  const std::filesystem::path directory = std::filesystem::temp_directory_path();
  std::string log = (directory / "ricochet-gmsh-version-XXXXXX").string();
  const int descriptor = mkstemp(log.data());
  if (descriptor < 0) throw Error(ErrorKind::file_access, fmt::format("cannot write to {}", directory.string()));
  close(descriptor);
  const Outcome outcome = run({"-version"}, directory, log);
  std::string version;
  std::string line;
  for (std::ifstream stream(log); std::getline(stream, line);) version += line;
  std::filesystem::remove(log);
  check_spawned(outcome, source);
  return version;
}

void run_program(const std::string& input, const std::string& options, const std::filesystem::path& workspace,
                 const std::filesystem::path& output) {
  // Merged after the input, so that these options overrule what the input sets; -3 meshes what there is, of any
  // dimension.
  const std::filesystem::path options_file = workspace / "options.geo";
  std::ofstream(options_file) << options;
  const std::filesystem::path log = workspace / "gmsh.log";
  const std::string absolute = std::filesystem::absolute(input).string();
  const Outcome outcome =
      run({absolute, options_file.string(), "-3", "-v", "2", "-nt", "1", "-o", output.string()}, workspace, log);
  check_spawned(outcome, input);
  std::error_code ignored;
  const bool written = std::filesystem::file_size(output, ignored) > 0 && !ignored;
  if (!WIFEXITED(outcome.status) || WEXITSTATUS(outcome.status) != 0 || !written) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: gmsh could not mesh this file: it {}{}:{}", input, describe(outcome),
                            written ? "" : " and wrote no mesh", last_lines(log)));
  }
}

}  // namespace ricochet::gmsh
