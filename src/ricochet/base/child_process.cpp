#include "ricochet/base/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "ricochet/base/interruption.hpp"

extern char** environ;

namespace ricochet {

namespace {

/// The variables of this process, but for those that are given anew.
std::vector<std::string> environment(const std::vector<std::string>& replacements) {
  std::vector<std::string> variables = replacements;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text(*variable);
    const bool replaced = std::any_of(replacements.begin(), replacements.end(), [text](const std::string& other) {
      return text.starts_with(other.substr(0, other.find('=') + 1));
    });
    if (!replaced) variables.emplace_back(text);
  }
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (std::string& string : strings) result.push_back(string.data());
  result.push_back(nullptr);
  return result;
}

/// In a group of its own, so that it ends when this process says so, with all that it has started; and with none of the
/// signals held back that this process may hold back.
class Attributes {
 public:
  Attributes() {
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setpgroup(&attributes_, 0);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
  }
  ~Attributes() { posix_spawnattr_destroy(&attributes_); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;

  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

/// Until it has ended; its number stays its own until it is asked how.
bool wait_for_end(pid_t process) {
  siginfo_t ignored;
  while (waitid(P_PID, static_cast<id_t>(process), &ignored, WEXITED | WNOWAIT) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

}  // namespace

bool ChildOutcome::is_absent() const {
  return spawn_error == ENOENT || (spawn_error == 0 && exit_status() == 127);
}

bool ChildOutcome::succeeded() const {
  return spawn_error == 0 && exit_status() == 0;
}

int ChildOutcome::exit_status() const {
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string ChildOutcome::description() const {
  if (spawn_error != 0) return fmt::format("cannot be run: {}", std::strerror(spawn_error));
  if (WIFSIGNALED(status)) return fmt::format("was killed by signal {}", WTERMSIG(status));
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

ChildOutcome run_child(ChildProcess child) {
  std::vector<std::string> variables = environment(child.variables);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, child.input.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, child.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  ChildOutcome outcome;
  pid_t process = 0;
  outcome.spawn_error = posix_spawnp(&process, child.arguments.front().c_str(), &actions, Attributes().get(),
                                     pointers(child.arguments).data(), pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (outcome.spawn_error != 0) return outcome;
  {
    const AtInterruption kill_child([process] {
      if (kill(-process, SIGKILL) == 0) wait_for_end(process);
    });
    if (!wait_for_end(process)) outcome.spawn_error = errno;
  }
  while (outcome.spawn_error == 0 && waitpid(process, &outcome.status, 0) < 0) {
    if (errno != EINTR) outcome.spawn_error = errno;
  }
  return outcome;
}

}  // namespace ricochet
