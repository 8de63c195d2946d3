#pragma once

#include <string>
#include <vector>

#include "ricochet/base/timer.hpp"

/// @file Progress of many runs on standard error: a bar on a terminal, a line for each that ends elsewhere.
namespace ricochet {

class StudyProgress {
 public:
  /// Of so many runs, of which some had ended before.
  StudyProgress(std::size_t runs, std::size_t ended_before, bool quiet);
  /// Ends the bar's line if one is open.
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;

  void begin(const std::string& directory);
  /// `words`: what has become of it.
  void end(const std::string& directory, const std::string& words);
  /// Looks how far the runs are, now and then.
  void watch();

 private:
  void draw();
  /// Of all runs, with the part that those that go on have done.
  [[nodiscard]] double runs_done() const;
  /// ", 12 s left": what the runs of this command have taken so far, of those that are left. "" before there is any.
  [[nodiscard]] std::string time_left(double done) const;

  std::size_t runs_, ended_before_, ended_;
  bool quiet_, terminal_, open_ = false;
  double last_drawn_ = 0.0;
  std::vector<std::string> running_;
  Timer timer_;
};

}  // namespace ricochet
