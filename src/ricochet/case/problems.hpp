#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"

/// @file Problems of a case file, which are collected so that the user sees all of them at once, and remarks on a valid
/// case.
namespace ricochet {

class Problems {
 public:
  void add(const SourceLocation& location, const std::string& message);
  /// Throws Error(invalid_input) with all problems, one per line, sorted by position, those of --set last; returns if
  /// there are none.
  void raise() const;

  void add_warning(const SourceLocation& location, const std::string& message);
  void add_info(const SourceLocation& location, const std::string& message);
  /// Writes warnings and infos to the log.
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
