#pragma once

#include <string>
#include <vector>

#include "ricochet/base/timer.hpp"

/// @file Progress of many runs on standard error: a bar on a terminal, else a line for each run that ends.
namespace ricochet {

class StudyProgress {
 public:
  /// Shows the progress of so many runs, some of which had ended before.
  StudyProgress(std::size_t runs, std::size_t ended_before, bool quiet);
  /// Ends the line of the bar if it is open.
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;

  void begin(const std::string& directory);
  /// `words`: the state in which it ended.
  void end(const std::string& directory, const std::string& words);
  /// Updates the progress of the runs from time to time.
  void watch();

 private:
  void draw();
  /// Returns the number of completed runs, including fractions of those in progress.
  [[nodiscard]] double runs_done() const;
  /// Returns ", 12 s left": an estimate for the remaining runs from those of this command. "" before the first has
  /// progressed.
  [[nodiscard]] std::string time_left(double done) const;

  std::size_t runs_, ended_before_, ended_;
  bool quiet_, terminal_, open_ = false;
  double last_drawn_ = 0.0;
  std::vector<std::string> running_;
  Timer timer_;
};

}  // namespace ricochet
