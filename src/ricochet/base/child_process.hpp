#pragma once

#include <string>
#include <vector>

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

/// Waits until it has ended.
[[nodiscard]] ChildOutcome run_child(ChildProcess child);

}  // namespace ricochet
