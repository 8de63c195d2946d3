#pragma once

#include <stdexcept>
#include <string>

/// @file Errors that reach a user. Each carries the exit status with which the program ends (design: the outside
/// contract).
namespace ricochet {

enum class ErrorKind : int {
  usage = 1,          ///< wrong use of the command line
  invalid_input = 2,  ///< invalid case or mesh
  not_converged = 3,  ///< a step did not converge
  file_access = 4,    ///< a file cannot be read or written
  expectation = 5,    ///< the run is complete but one of its [[expect]] entries does not hold
};

/// An error whose one message says what went wrong, where (file:line:column or entity) and what to do about it.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  [[nodiscard]] ErrorKind kind() const { return kind_; }
  [[nodiscard]] int exit_status() const { return int(kind_); }

 private:
  ErrorKind kind_;
};

}  // namespace ricochet
