#pragma once

#include <memory>

namespace ricochet {

/// For as long as it lives, children that end wait until they are asked how. Of a process that ignores SIGCHLD, as
/// those that some daemons start do, they vanish before.
class KeptChildren {
 public:
  KeptChildren();
  ~KeptChildren();
  KeptChildren(const KeptChildren&) = delete;
  KeptChildren& operator=(const KeptChildren&) = delete;

 private:
  struct Before;
  std::unique_ptr<Before> before_;  ///< null: they are kept anyway
};

}  // namespace ricochet
