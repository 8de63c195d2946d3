#pragma once

#include <string>

#include "ricochet/base/types.hpp"

namespace ricochet {

/// A node that is watched.
struct Probe {
  std::string name;
  Index node = 0;
  double distance = 0.0;    ///< from the point (or the segment) asked for
  Index contact_node = -1;  ///< its (first) entry among the nodes of the contact boundary, or −1
};

}  // namespace ricochet
