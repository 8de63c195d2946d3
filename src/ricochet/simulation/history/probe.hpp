#pragma once

#include <string>

#include "ricochet/base/types.hpp"

namespace ricochet {

/// Node that is monitored.
struct Probe {
  std::string name;
  Index node = 0;           ///< −1: not among the nodes of this rank
  double distance = 0.0;    ///< from the requested point (or segment)
  Index contact_node = -1;  ///< its index among the nodes of the contact boundary, if several the one with the least
                            ///< gap
                            ///< at the start; −1 if none
  Index number = -1;        ///< number of the node for messages and results
};

}  // namespace ricochet
