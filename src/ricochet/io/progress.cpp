#include "ricochet/io/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace ricochet {

namespace {

/// Seconds between lines of a run without a terminal, which reports at each tenth in any case. The first line shows the
/// estimate that follows from the first steps.
constexpr double longest_silence = 60.0, first_silence = 5.0;

/// Ignores write errors: a run must not end because its progress cannot be displayed.
void show(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.1f} s", seconds);
  const long whole = long(seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

Progress::Progress(long steps, double end, bool quiet, long first_step, double first_time)
    : steps_(steps),
      end_(end),
      first_done_(done(first_step, first_time)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_tenth_(int(first_done_ * 10.0) + 1) {}

Progress::~Progress() {
  if (open_) std::fputc('\n', stderr);
}

double Progress::done(long step, double time) const {
  if (steps_ > 0) return double(step) / double(steps_);
  return std::min(1.0, time / end_);
}

void Progress::update(long step, double time) {
  if (quiet_) return;
  const double now = timer_.seconds(), part = done(step, time);
  if (terminal_) {
    if (part < 1.0 && now - last_drawn_ < 0.1) return;
  } else {
    if (part * 10.0 < next_tenth_ && now - last_drawn_ < (has_drawn_ ? longest_silence : first_silence)) return;
    has_drawn_ = true;
    next_tenth_ = int(part * 10.0) + 1;
  }
  last_drawn_ = now;
  draw(step, time);
}

void Progress::draw(long step, double time) {
  const double part = done(step, time);
  const double elapsed = timer_.seconds();
  const double left = part > first_done_ ? elapsed / (part - first_done_) * (1.0 - part) : 0.0;
  const std::string of_all = steps_ > 0 ? fmt::format("/{}", steps_) : "";
  const std::string numbers = fmt::format("step {}{}  t = {:.6g}  {} elapsed, {} left", step, of_all, time,
                                          duration_text(elapsed), duration_text(left));
  if (!terminal_) {
    show(fmt::format("{:3.0f} %  {}\n", 100.0 * part, numbers));
    return;
  }
  constexpr int width = 30;
  const int filled = int(part * width);
  show(fmt::format("\r[{:#<{}}{:.<{}}] {}\033[K", "", filled, "", width - filled, numbers));
  open_ = true;
}

}  // namespace ricochet
