#pragma once

#include <Eigen/Core>

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

  static constexpr Index numbers = 7;
  [[nodiscard]] Eigen::Matrix<double, numbers, 1> to_numbers() const {
    Eigen::Matrix<double, numbers, 1> result;
    result << static_cast<double>(node), depth, time, position, first_time;
    return result;
  }
  [[nodiscard]] static DeepestPoint from_numbers(const Eigen::Matrix<double, numbers, 1>& values) {
    return {static_cast<Index>(values[0]), values[1], values[2], values.segment<3>(3), values[6]};
  }
};

/// Depth, relative to the size of the body, up to which it is rounding.
inline constexpr double rounding_of_depth = 1e-9;

}  // namespace ricochet
