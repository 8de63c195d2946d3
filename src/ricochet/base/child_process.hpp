#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/default_sigchld_guard.hpp"
#include "ricochet/base/interruption.hpp"

/// @file Running another program. Its arguments are passed on unchanged: no shell is involved.
namespace ricochet {

struct ChildProcess {
  std::vector<std::string> arguments;       ///< the first is the program: a path, or a name that is found in PATH
  std::vector<std::string> variables = {};  ///< "NAME=value", replacing those of this process
  std::string input = "/dev/null";          ///< file that it reads as standard input
  std::string output;                       ///< file that receives its standard output and standard error
};

struct ChildResult {
  int spawn_error = 0;  ///< errno if it could not be started
  int status = 0;       ///< as returned by waitpid

  /// Returns whether there is no such program.
  [[nodiscard]] bool is_absent() const;
  [[nodiscard]] bool succeeded() const;
  /// Exit status; −1 if it did not exit by itself.
  [[nodiscard]] int exit_status() const;
  /// Returns "ended with status 1", "was killed by signal 9", "cannot be run: …".
  [[nodiscard]] std::string description() const;
};

/// A child process that runs beside this one. It is killed when the thread that started it ends, however that ends.
class RunningChild {
 public:
  /// Starts the child. A child that cannot be started counts as ended, and its result states the reason.
  explicit RunningChild(ChildProcess child);
  /// Kills the child and all processes that it has started, unless it has ended.
  ~RunningChild();
  RunningChild(const RunningChild&) = delete;
  RunningChild& operator=(const RunningChild&) = delete;

  /// Checks without waiting.
  [[nodiscard]] bool has_ended();
  /// Waits until the child has ended.
  void wait();
  /// Sends a signal to the child and to all processes that it has started; has no effect after its end.
  void send(int signal);
  /// Result of a child that has ended.
  [[nodiscard]] const ChildResult& result() const { return result_; }

 private:
  class SharedErrno;
  /// Reaps the child and stores how it ended.
  void collect();

  DefaultSigchldGuard sigchld_guard_;
  pid_t process_ = -1;
  ChildResult result_;
  std::unique_ptr<SharedErrno> error_;
  std::optional<AtInterruption> kill_when_interrupted_;
};

/// Runs the child and waits until it has ended.
[[nodiscard]] ChildResult run_child(ChildProcess child);

}  // namespace ricochet
