#pragma once

#include <string>

#include "ricochet/base/types.hpp"

namespace ricochet {

/// A node that is watched.
struct Probe {
  std::string name;
  Index node = 0;           ///< −1: it is not among the nodes of this rank
  double distance = 0.0;    ///< from the point (or the segment) asked for
  Index contact_node = -1;  ///< its entry among the nodes of the contact boundary, of several that with the least gap
                            ///< at the start; or −1
  Index number = -1;        ///< people's, of the node
};

}  // namespace ricochet
