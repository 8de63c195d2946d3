#pragma once

#include <csignal>

/// @file Signals that must not be delivered now.
namespace ricochet {

/// Blocks external signals (not those caused by a thread's own errors) for the lifetime of this object, on this thread
/// and on the threads that it starts meanwhile, which keep them blocked. If all other threads were started in this way,
/// a signal to the process stays pending.
class BlockedSignals {
 public:
  BlockedSignals();
  ~BlockedSignals();
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace ricochet
