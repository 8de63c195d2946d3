#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"

/// @file Problems of a case file are collected, so that a user sees all of them at once; and what a user should know of
/// a case that is valid.
namespace ricochet {

class Problems {
 public:
  void add(const SourceLocation& location, const std::string& message);
  /// Throws Error(invalid_input) with all of them, one per line, sorted by position, those of --set last; or returns.
  void raise() const;

  void add_warning(const SourceLocation& location, const std::string& message);
  void add_info(const SourceLocation& location, const std::string& message);
  /// Told to the log.
  void log_remarks() const;

 private:
  struct Problem {
    SourceLocation location;
    std::string message;
  };
  std::vector<Problem> problems_;
  std::vector<std::string> warnings_, infos_;
};

}  // namespace ricochet
