#include "ricochet/io/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace ricochet {

namespace {

/// Seconds between lines of a run that is not watched at a terminal; it says something at each tenth anyway.
constexpr double longest_silence = 60.0;

/// Nobody's run should end because what is merely shown cannot be written.
void show(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 60.0) return fmt::format("{:.1f} s", seconds);
  const long whole = static_cast<long>(seconds);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

Progress::Progress(long steps, bool quiet, long first_step)
    : steps_(steps),
      first_step_(first_step),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_tenth_(first_step * 10 / steps + 1) {}

Progress::~Progress() {
  if (open_) std::fputc('\n', stderr);
}

void Progress::update(long step, double time) {
  if (quiet_) return;
  if (terminal_) {
    const double now = timer_.seconds();
    if (step < steps_ && now - last_drawn_ < 0.1) return;
    last_drawn_ = now;
    draw(step, time);
  } else {
    const double now = timer_.seconds();
    if (step * 10 < next_tenth_ * steps_ && now - last_drawn_ < longest_silence) return;
    next_tenth_ = step * 10 / steps_ + 1;
    last_drawn_ = now;
    draw(step, time);
  }
}

void Progress::draw(long step, double time) {
  const double done = static_cast<double>(step) / static_cast<double>(steps_);
  const double elapsed = timer_.seconds();
  const double left =
      step > first_step_ ? elapsed / static_cast<double>(step - first_step_) * static_cast<double>(steps_ - step) : 0.0;
  const std::string numbers = fmt::format("step {}/{}  t = {:.6g}  {} gone, {} left", step, steps_, time,
                                          duration_text(elapsed), duration_text(left));
  if (!terminal_) {
    show(fmt::format("{:3.0f} %  {}\n", 100.0 * done, numbers));
    return;
  }
  constexpr int width = 30;
  const int filled = static_cast<int>(done * width);
  show(fmt::format("\r[{:#<{}}{:.<{}}] {}\033[K", "", filled, "", width - filled, numbers));
  open_ = true;
}

}  // namespace ricochet
