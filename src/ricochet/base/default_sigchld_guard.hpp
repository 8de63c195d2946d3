#pragma once

#include <memory>

namespace ricochet {

/// Keeps children that have ended as zombies for its lifetime, until they are waited for. In a process that ignores
/// SIGCHLD, as some daemons start theirs, they would vanish first.
class DefaultSigchldGuard {
 public:
  DefaultSigchldGuard();
  ~DefaultSigchldGuard();
  DefaultSigchldGuard(const DefaultSigchldGuard&) = delete;
  DefaultSigchldGuard& operator=(const DefaultSigchldGuard&) = delete;

 private:
  struct Before;
  std::unique_ptr<Before> before_;  ///< null if nothing had to be changed
};

}  // namespace ricochet
