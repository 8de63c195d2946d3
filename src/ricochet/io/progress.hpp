#pragma once

#include <string>

#include "ricochet/base/timer.hpp"

/// @file Progress of a run on standard error: a bar with the remaining time on a terminal, otherwise a line per tenth.
namespace ricochet {

class Progress {
 public:
  /// Progress of a run that begins (or resumes) after this step and time. `steps`: 0 if unknown.
  Progress(long steps, double end, bool quiet, long first_step, double first_time);
  /// Ends the bar's line if one is open.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Cheap: reads the clock only occasionally.
  void update(long step, double time);

 private:
  void draw(long step, double time);
  /// Completed fraction, 0 to 1.
  [[nodiscard]] double done(long step, double time) const;

  long steps_;
  double end_;
  double first_done_;
  bool quiet_;
  bool terminal_;
  bool open_ = false, has_drawn_ = false;
  int next_tenth_ = 1;
  double last_drawn_ = 0.0;
  Timer timer_;
};

/// "1.5 s", "2 min 05 s", "3 h 20 min".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace ricochet
