#pragma once

#include <ctime>

namespace ricochet {

/// Seconds of processor time: the solvers are serial, and the machine may be shared.
class ProcessorTimer {
 public:
  [[nodiscard]] double seconds() const { return now() - start_; }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double start_ = now();
};

}  // namespace ricochet
