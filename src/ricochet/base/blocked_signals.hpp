#pragma once

#include <csignal>

/// @file Signals that must not come now.
namespace ricochet {

/// Signals from outside (not those of a thread's own errors) wait until the end of this object's life, on this thread
/// and those that it starts meanwhile, which keep waiting. Where all other threads were started so, a signal to the
/// process waits.
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
