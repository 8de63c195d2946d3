#include "ricochet/base/kept_children.hpp"

#include <signal.h>

namespace ricochet {

struct KeptChildren::Before {
  struct sigaction action {};
};

KeptChildren::KeptChildren() : before_(std::make_unique<Before>()) {
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  const bool ignores = sigaction(SIGCHLD, nullptr, &before_->action) == 0 && before_->action.sa_handler == SIG_IGN;
  if (!ignores || sigaction(SIGCHLD, &standard, nullptr) != 0) before_.reset();
}

KeptChildren::~KeptChildren() {
  if (before_) sigaction(SIGCHLD, &before_->action, nullptr);
}

}  // namespace ricochet
