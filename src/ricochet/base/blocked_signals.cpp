#include "ricochet/base/blocked_signals.hpp"

namespace ricochet {

BlockedSignals::BlockedSignals() {
  sigset_t from_outside;
  sigemptyset(&from_outside);
  constexpr int signals[] = {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGALRM};
  for (const int signal : signals) sigaddset(&from_outside, signal);
  pthread_sigmask(SIG_BLOCK, &from_outside, &before_);
}

BlockedSignals::~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

}  // namespace ricochet
