#include "ricochet/base/child_processes.hpp"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <list>
#include <thread>

#include "ricochet/base/interruption.hpp"
#include "ricochet/base/timer.hpp"

namespace ricochet {

namespace {

/// Seconds between two polls of the children, and between two calls of PoolWork::watch.
constexpr double poll_interval = 0.005, watch_interval = 0.1;
/// Seconds that children have to end by themselves: a run takes two.
constexpr double longest_farewell = 5.0;

struct NumberedChild {
  NumberedChild(std::size_t i, ChildProcess child) : number(i), process(std::move(child)) {}
  std::size_t number;
  RunningChild process;
};

void pause_between_polls() { std::this_thread::sleep_for(std::chrono::duration<double>(poll_interval)); }

void remove_ended(std::list<NumberedChild>& running, const PoolWork& work) {
  for (auto child = running.begin(); child != running.end();) {
    if (child->process.has_ended()) {
      work.ended(child->number, child->process.result());
      child = running.erase(child);
    } else {
      ++child;
    }
  }
}

void end_all(std::list<NumberedChild>& running, const PoolWork& work) {
  for (NumberedChild& child : running) child.process.send(SIGTERM);
  for (const Timer timer; !running.empty() && timer.seconds() < longest_farewell; pause_between_polls())
    remove_ended(running, work);
  for (NumberedChild& child : running) child.process.send(SIGKILL);
  for (; !running.empty(); pause_between_polls()) remove_ended(running, work);
}

}  // namespace

std::size_t usable_cores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof cores, &cores) != 0) return std::max(1u, std::thread::hardware_concurrency());
  return std::size_t(std::max(1, CPU_COUNT(&cores)));
}

int run_children(std::size_t count, std::size_t at_once, const PoolWork& work) {
  const StoppingPoints stopping_points;
  std::list<NumberedChild> running;
  Timer since_watch;
  for (std::size_t next = 0; next < count || !running.empty();) {
    if (const int signal = work.stop_signal ? work.stop_signal() : 0; signal != 0) {
      interruption::reach_stopping_point();
      end_all(running, work);
      return signal;
    }
    while (next < count && running.size() < std::max<std::size_t>(at_once, 1)) {
      running.emplace_back(next, work.make(next));
      ++next;
    }
    pause_between_polls();
    remove_ended(running, work);
    if (work.watch && since_watch.seconds() >= watch_interval) {
      work.watch();
      since_watch.restart();
    }
  }
  return 0;
}

}  // namespace ricochet
