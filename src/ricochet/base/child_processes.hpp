#pragma once

#include <cstddef>
#include <functional>

#include "ricochet/base/child_process.hpp"

/// @file Many child processes, some of them at a time.
namespace ricochet {

/// Cores that this process may use (its affinity), at least one.
[[nodiscard]] std::size_t usable_cores();

/// What a pool asks and tells while it works; all on the thread that called it.
struct PoolWork {
  /// Child number i, when its turn has come.
  std::function<ChildProcess(std::size_t i)> make;
  /// It has ended, by itself or as the pool was stopped.
  std::function<void(std::size_t i, const ChildOutcome& outcome)> ended;
  /// Some ten times a second; may be empty.
  std::function<void()> watch = {};
  /// Not 0: the number of the signal that is to end the work. May be empty.
  std::function<int()> stop_signal = {};
};

/// Runs children 0 to `count` − 1 in this order, so many at once. When a signal is to end the work, no more are
/// started; those that run get SIGTERM, and five seconds later SIGKILL. Returns that signal, or 0 when all have run.
[[nodiscard]] int run_children(std::size_t count, std::size_t at_once, const PoolWork& work);

}  // namespace ricochet
