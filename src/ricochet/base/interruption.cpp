#include "ricochet/base/interruption.hpp"

#include <poll.h>
#include <unistd.h>

#include <cstring>
#include <exception>
#include <mutex>
#include <utility>

namespace ricochet {

namespace {

/// Never destroyed, since the request may arrive while the process ends.
struct Registry {
  std::mutex mutex;
  std::list<std::function<void()>> actions;
  bool at_stopping_point = false;
  int stopping_points = 0;
};

Registry& registry() {
  static auto* const instance = new Registry;
  return *instance;
}

}  // namespace

AtInterruption::AtInterruption(std::function<void()> action) : AtInterruption([] {}, std::move(action)) {}

AtInterruption::AtInterruption(const std::function<void()>& begin, std::function<void()> action) {
  const std::lock_guard lock(registry().mutex);
  begin();
  entry_ = registry().actions.insert(registry().actions.end(), std::move(action));
}

AtInterruption::~AtInterruption() {
  const std::lock_guard lock(registry().mutex);
  registry().actions.erase(entry_);
}

StoppingPoints::StoppingPoints() {
  const std::lock_guard lock(registry().mutex);
  // A stopping point reached before belongs to other work.
  if (registry().stopping_points++ == 0) registry().at_stopping_point = false;
}

StoppingPoints::~StoppingPoints() {
  const std::lock_guard lock(registry().mutex);
  --registry().stopping_points;
}

namespace interruption {

void reach_stopping_point() {
  const std::lock_guard lock(registry().mutex);
  registry().at_stopping_point = true;
}

bool has_stopping_points() {
  const std::lock_guard lock(registry().mutex);
  return registry().stopping_points > 0;
}

bool run_actions() {
  std::unique_lock lock(registry().mutex);
  if (registry().at_stopping_point) return false;
  for (auto action = registry().actions.rbegin(); action != registry().actions.rend(); ++action) {
    try {
      (*action)();
    } catch (const std::exception&) {  // the remaining actions run all the same
    }
  }
  static_cast<void>(lock.release());  // no other thread may continue
  return true;
}

void write_to_stderr(const char* line) {
  struct pollfd output {
    STDERR_FILENO, POLLOUT, 0
  };
  if (poll(&output, 1, 0) == 1 && (output.revents & POLLOUT) != 0)
    static_cast<void>(!write(STDERR_FILENO, line, std::strlen(line)));
}

}  // namespace interruption

}  // namespace ricochet
