#pragma once

#include <Eigen/Core>
#include <tuple>

#include "ricochet/base/types.hpp"

/// @file Deepest penetration so far, with its position and time.
namespace ricochet {

struct DeepestPoint {
  Index node = -1;  ///< −1: none found
  double depth = 0.0, time = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< position of the node at that time
  double first_time = 0.0;

  [[nodiscard]] bool found() const { return node >= 0; }
  void enter(Index at_node, double at_depth, double at_time, const Eigen::Vector3d& at_position) {
    if (at_depth <= depth) return;
    if (!found()) first_time = at_time;
    node = at_node;
    depth = at_depth;
    time = at_time;
    position = at_position;
  }

  [[nodiscard]] auto members() { return std::tie(node, depth, time, position, first_time); }
};

/// Depth, relative to the size of the body, up to which it is rounding.
inline constexpr double rounding_of_depth = 1e-9;

}  // namespace ricochet
