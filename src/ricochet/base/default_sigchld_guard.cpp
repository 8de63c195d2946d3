#include "ricochet/base/default_sigchld_guard.hpp"

#include <signal.h>

namespace ricochet {

struct DefaultSigchldGuard::Before {
  struct sigaction action {};
};

DefaultSigchldGuard::DefaultSigchldGuard() : before_(std::make_unique<Before>()) {
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  const bool ignores = sigaction(SIGCHLD, nullptr, &before_->action) == 0 && before_->action.sa_handler == SIG_IGN;
  if (!ignores || sigaction(SIGCHLD, &standard, nullptr) != 0) before_.reset();
}

DefaultSigchldGuard::~DefaultSigchldGuard() {
  if (before_) sigaction(SIGCHLD, &before_->action, nullptr);
}

}  // namespace ricochet
