#include "ricochet/base/trial.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "ricochet/base/default_sigchld_guard.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Prepares the child. Only waitpid reports how the child ended: handlers of this process, such as Python's
/// faulthandler, must not speak for it, and a signal that asks the process to end is meant for the parent.
void prepare_child(pid_t parent, double processor_seconds) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it was killed before prctl
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU}) signal(number, SIG_DFL);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const struct rlimit no_core { 0, 0 };
  setrlimit(RLIMIT_CORE, &no_core);
  const auto seconds = static_cast<rlim_t>(std::ceil(processor_seconds));
  const struct rlimit processor { seconds, seconds + 1 };
  setrlimit(RLIMIT_CPU, &processor);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
}

}  // namespace

std::string TrialResult::description() const {
  if (endless) return "does not end";
  return signal != 0 ? fmt::format("crashed with signal {}", signal) : "failed";
}

TrialResult try_in_child(const std::function<bool()>& work, double processor_seconds) {
  const DefaultSigchldGuard sigchld_guard;
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw Error(ErrorKind::file_access, fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (child == 0) {
    prepare_child(parent, processor_seconds);
    bool good = false;
    try {
      good = work();
    } catch (...) {  // counts as failed
    }
    _exit(good ? 0 : 1);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR)
      throw Error(ErrorKind::file_access, fmt::format("cannot wait for a process: {}", std::strerror(errno)));
  }
  TrialResult result;
  result.succeeded = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  result.endless = result.signal == SIGXCPU;
  return result;
}

}  // namespace ricochet
