#pragma once

#include <chrono>

/// @file Wall-clock time.
namespace ricochet {

class Timer {
 public:
  /// Seconds since construction or the last restart.
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(clock::now() - start_).count(); }
  double restart() {
    const double elapsed = seconds();
    start_ = clock::now();
    return elapsed;
  }

 private:
  using clock = std::chrono::steady_clock;
  clock::time_point start_ = clock::now();
};

}  // namespace ricochet
