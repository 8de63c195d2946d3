#include "ricochet/base/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

extern char** environ;

namespace ricochet {

namespace {

/// Returns the variables of this process, except those that are replaced.
std::vector<std::string> environment(const std::vector<std::string>& replacements) {
  std::vector<std::string> variables = replacements;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text(*variable);
    const bool replaced = std::ranges::any_of(replacements, [text](const std::string& other) {
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

bool redirect(const char* path, int flags, int stream) {
  const int file = open(path, flags, 0600);
  if (file < 0 || (file != stream && dup2(file, stream) < 0)) return false;
  if (file != stream) close(file);
  return true;
}

/// Runs in the child between fork and exec, where only async-signal-safe functions may be called. The child leads a
/// process group, so that its parent can end it with all processes that it has started; it is killed when the parent is
/// killed; and it blocks none of the signals that the parent may block.
[[noreturn]] void become(const ChildProcess& child, pid_t parent, char* const* arguments, char* const* variables,
                         int& error) {
  setpgid(0, 0);
  // More precisely, when the thread ends that has started the child. That thread waits for the child.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // it was killed before prctl
  if (redirect(child.input.c_str(), O_RDONLY, STDIN_FILENO) &&
      redirect(child.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO) &&
      dup2(STDOUT_FILENO, STDERR_FILENO) >= 0) {
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    execvpe(arguments[0], arguments, variables);
  }
  error = errno;
  _exit(127);
}

/// Returns whether the child has ended; with WNOHANG, without waiting. The child is not reaped, so its process id stays
/// its own. Does not throw: if the state cannot be found out, returns true and sets `problem` to errno.
bool query_exit(pid_t process, int options, int& problem) {
  siginfo_t found{};
  while (waitid(P_PID, static_cast<id_t>(process), &found, WEXITED | WNOWAIT | options) != 0) {
    if (errno == EINTR) continue;
    problem = errno;
    return true;
  }
  return found.si_pid != 0;
}

}  // namespace

bool ChildResult::is_absent() const { return spawn_error == ENOENT || (spawn_error == 0 && exit_status() == 127); }

bool ChildResult::succeeded() const { return spawn_error == 0 && exit_status() == 0; }

int ChildResult::exit_status() const { return WIFEXITED(status) ? WEXITSTATUS(status) : -1; }

std::string ChildResult::description() const {
  if (spawn_error != 0) return fmt::format("cannot be run: {}", std::strerror(spawn_error));
  if (WIFSIGNALED(status)) return fmt::format("was killed by signal {}", WTERMSIG(status));
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

/// Passes to this process why its child could not execute the other program, through shared memory.
class RunningChild::SharedErrno {
 public:
  SharedErrno() : number_(mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {}
  ~SharedErrno() {
    if (exists()) munmap(number_, sizeof(int));
  }
  SharedErrno(const SharedErrno&) = delete;
  SharedErrno& operator=(const SharedErrno&) = delete;

  [[nodiscard]] bool exists() const { return number_ != MAP_FAILED; }
  [[nodiscard]] int& value() const { return *static_cast<int*>(number_); }

 private:
  void* number_;
};

RunningChild::RunningChild(ChildProcess child) : error_(std::make_unique<SharedErrno>()) {
  std::vector<std::string> variables = environment(child.variables);
  const std::vector<char*> arguments = pointers(child.arguments), all_variables = pointers(variables);
  if (!error_->exists()) {
    result_.spawn_error = errno;
    return;
  }
  const auto start = [&] {
    const pid_t parent = getpid();
    process_ = _Fork();  // skips the fork handlers of libraries, which are not called in the child
    if (process_ == 0) become(child, parent, arguments.data(), all_variables.data(), error_->value());
    if (process_ < 0) result_.spawn_error = errno;
    if (process_ > 0) setpgid(process_, process_);  // done in parent and child, whichever is first
  };
  kill_when_interrupted_.emplace(start, [this] {
    int ignored = 0;
    if (process_ > 0 && kill(-process_, SIGKILL) == 0) query_exit(process_, 0, ignored);
  });
  if (process_ < 0) kill_when_interrupted_.reset();
}

RunningChild::~RunningChild() {
  send(SIGKILL);
  wait();
}

bool RunningChild::has_ended() {
  if (process_ < 0) return true;
  if (!query_exit(process_, WNOHANG, result_.spawn_error)) return false;
  collect();
  return true;
}

void RunningChild::wait() {
  if (process_ < 0) return;
  query_exit(process_, 0, result_.spawn_error);
  collect();
}

void RunningChild::send(int signal) {
  if (process_ > 0) kill(-process_, signal);
}

void RunningChild::collect() {
  kill_when_interrupted_.reset();  // before its process id may be reused
  while (result_.spawn_error == 0 && waitpid(process_, &result_.status, 0) < 0) {
    if (errno != EINTR) result_.spawn_error = errno;
  }
  if (result_.spawn_error == 0) result_.spawn_error = error_->value();
  process_ = -1;
}

ChildResult run_child(ChildProcess child) {
  RunningChild running(std::move(child));
  running.wait();
  return running.result();
}

}  // namespace ricochet
