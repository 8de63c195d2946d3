#include "ricochet/study/study_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "ricochet/base/error.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/io/summary.hpp"

namespace ricochet {

namespace {

/// Seconds between two readings of the summaries of runs, which are written every two seconds.
constexpr double redraw_interval = 0.5;

/// Returns the fraction of its steps that a run has completed, from its summary.
double part_done(const std::string& directory) {
  try {
    return read_summary(directory + "/summary.json").part_done();
  } catch (const Error&) {  // no summary yet
    return 0.0;
  }
}

}  // namespace

StudyProgress::StudyProgress(std::size_t runs, std::size_t ended_before, bool quiet)
    : runs_(runs),
      ended_before_(ended_before),
      ended_(ended_before),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0) {}

StudyProgress::~StudyProgress() {
  if (open_) std::fputc('\n', stderr);
}

void StudyProgress::begin(const std::string& directory) {
  running_.push_back(directory);
}

void StudyProgress::end(const std::string& directory, const std::string& words) {
  std::erase(running_, directory);
  ++ended_;
  if (quiet_) return;
  if (terminal_) {
    draw();
  } else {
    fmt::print(stderr, "{}/{}  {}: {}{}\n", ended_, runs_, directory, words, time_left(runs_done()));
  }
}

void StudyProgress::watch() {
  if (!quiet_ && terminal_ && timer_.seconds() - last_drawn_ >= redraw_interval) draw();
}

double StudyProgress::runs_done() const {
  auto done = static_cast<double>(ended_);
  for (const std::string& directory : running_) done += part_done(directory);
  return done;
}

std::string StudyProgress::time_left(double done) const {
  const double here = done - static_cast<double>(ended_before_), left = static_cast<double>(runs_) - done;
  if (!(here > 0.0 && left > 0.0)) return "";
  // The mean time per run includes the number of jobs, which stays the same.
  return fmt::format(", {} left", duration_text(timer_.seconds() / here * left));
}

void StudyProgress::draw() {
  last_drawn_ = timer_.seconds();
  const double done = runs_done();
  constexpr int width = 30;
  const int filled = static_cast<int>(width * done / static_cast<double>(runs_));
  fmt::print(stderr, "\r[{:#<{}}{:.<{}}] {}/{} runs, {} running  {} elapsed{}\033[K", "", filled, "", width - filled,
             ended_, runs_, running_.size(), duration_text(last_drawn_), time_left(done));
  std::fflush(stderr);
  open_ = true;
}

}  // namespace ricochet
