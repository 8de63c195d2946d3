#pragma once

#include <string>

#include "ricochet/base/timer.hpp"

/// @file Progress of a run on standard error: a bar with the time left on a terminal, a line per tenth elsewhere.
namespace ricochet {

class Progress {
 public:
  /// Of a run that begins (or goes on) after this step.
  Progress(long steps, bool quiet, long first_step = 0);
  /// Ends the bar's line if one is open.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Cheap: looks at the clock only now and then.
  void update(long step, double time);

 private:
  void draw(long step, double time);

  long steps_;
  long first_step_;
  bool quiet_;
  bool terminal_;
  bool open_ = false;
  long next_tenth_ = 1;
  double last_drawn_ = 0.0;
  Timer timer_;
};

/// "1.5 s", "2 min 05 s", "3 h 20 min".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace ricochet
