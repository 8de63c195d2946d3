#pragma once

#include <chrono>
#include <ctime>

/// @file Wall-clock time and processor time.
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

/// Processor time of all cores on which this process has run, user and system.
class ProcessorTimer {
 public:
  /// Seconds since construction.
  [[nodiscard]] double seconds() const { return now() - start_; }

 private:
  [[nodiscard]] static double now() {
    struct timespec time {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
  }
  double start_ = now();
};

}  // namespace ricochet
