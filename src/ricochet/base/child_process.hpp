#pragma once

#include <sys/types.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/interruption.hpp"
#include "ricochet/base/kept_children.hpp"

/// @file Running another program. Its arguments go to it as they are: no shell is involved.
namespace ricochet {

struct ChildProcess {
  std::vector<std::string> arguments;       ///< the first is the program, a path or a name to be found in PATH
  std::vector<std::string> variables = {};  ///< "NAME=value", in place of those of this process
  std::string input = "/dev/null";          ///< the file that it reads as standard input
  std::string output;                       ///< the file that takes what it says, errors included
};

struct ChildOutcome {
  int spawn_error = 0;  ///< errno where it could not be started
  int status = 0;       ///< as waitpid gives it

  /// There is no such program.
  [[nodiscard]] bool is_absent() const;
  [[nodiscard]] bool succeeded() const;
  /// The status it ended with by itself; −1: it did not.
  [[nodiscard]] int exit_status() const;
  /// "ended with status 1", "was killed by signal 9", "cannot be run: …".
  [[nodiscard]] std::string description() const;
};

/// A child that runs beside this process. It ends with the thread that has made it, however that ends.
class RunningChild {
 public:
  /// Starts it. Where it cannot be started it has ended, and its outcome says why.
  explicit RunningChild(ChildProcess child);
  /// Kills it, with all that it has started, unless it has ended.
  ~RunningChild();
  RunningChild(const RunningChild&) = delete;
  RunningChild& operator=(const RunningChild&) = delete;

  /// Looks, and does not wait.
  [[nodiscard]] bool has_ended();
  /// Waits until it has ended.
  void wait();
  /// To it and all that it has started; nothing happens where it has ended.
  void send(int signal);
  /// Of one that has ended.
  [[nodiscard]] const ChildOutcome& outcome() const { return outcome_; }

 private:
  class SharedErrno;
  /// Takes note of how it has ended.
  void collect();

  KeptChildren kept_;
  pid_t process_ = -1;
  ChildOutcome outcome_;
  std::unique_ptr<SharedErrno> error_;
  std::optional<AtInterruption> kill_when_interrupted_;
};

/// Waits until it has ended.
[[nodiscard]] ChildOutcome run_child(ChildProcess child);

}  // namespace ricochet
