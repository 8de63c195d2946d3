#pragma once

#include <cstddef>
#include <functional>

#include "ricochet/base/child_process.hpp"

/// @file Many child processes, of which a limited number run at a time.
namespace ricochet {

/// Number of cores that this process may use (its affinity), at least one.
[[nodiscard]] std::size_t usable_cores();

/// Callbacks of a pool, all called on the thread that runs the pool.
struct PoolWork {
  /// Makes child number i when it is about to start.
  std::function<ChildProcess(std::size_t i)> make;
  /// Reports that a child has ended, by itself or because the pool was stopped.
  std::function<void(std::size_t i, const ChildResult& result)> ended;
  /// Is called some ten times a second; may be empty.
  std::function<void()> watch = {};
  /// Returns the number of the signal that ends the work, or 0; may be empty.
  std::function<int()> stop_signal = {};
};

/// Runs children 0 to `count` − 1 in this order, at most `at_once` at a time. After a stop signal no more are started;
/// running ones get SIGTERM, and SIGKILL five seconds later. Returns that signal, or 0 when all have run.
[[nodiscard]] int run_children(std::size_t count, std::size_t at_once, const PoolWork& work);

}  // namespace ricochet
