#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"

/// @file Problems of a case file are collected, so that a user sees all of them at once.
namespace ricochet {

class Problems {
 public:
  void add(const SourceLocation& location, const std::string& message);
  /// Throws Error(invalid_input) with all of them, one per line, sorted by position, those of --set last; or returns.
  void raise() const;

 private:
  struct Problem {
    SourceLocation location;
    std::string message;
  };
  std::vector<Problem> problems_;
};

}  // namespace ricochet
