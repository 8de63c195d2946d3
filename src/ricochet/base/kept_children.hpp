#pragma once

#include <signal.h>

namespace ricochet {

/// For as long as it lives, children that end wait until they are asked how. Of a process that ignores SIGCHLD, as
/// those that some daemons start do, they vanish before.
class KeptChildren {
 public:
  KeptChildren() {
    struct sigaction standard {};
    standard.sa_handler = SIG_DFL;
    sigaction(SIGCHLD, nullptr, &before_);
    changed_ = before_.sa_handler == SIG_IGN && sigaction(SIGCHLD, &standard, nullptr) == 0;
  }
  ~KeptChildren() {
    if (changed_) sigaction(SIGCHLD, &before_, nullptr);
  }
  KeptChildren(const KeptChildren&) = delete;
  KeptChildren& operator=(const KeptChildren&) = delete;

 private:
  struct sigaction before_ {};
  bool changed_ = false;
};

}  // namespace ricochet
