#pragma once

#include <memory>

namespace ricochet {

/// Keeps children that have ended as zombies for its lifetime, until they are waited for. In a process that ignores
/// SIGCHLD, as some daemons start theirs, they would vanish first.
class KeptChildren {
 public:
  KeptChildren();
  ~KeptChildren();
  KeptChildren(const KeptChildren&) = delete;
  KeptChildren& operator=(const KeptChildren&) = delete;

 private:
  struct Before;
  std::unique_ptr<Before> before_;  ///< null if nothing had to be changed
};

}  // namespace ricochet
