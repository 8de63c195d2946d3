#pragma once

#include "ricochet/base/space_vector.hpp"

/// @file Pose of a rigid obstacle.
namespace ricochet {

/// The map x = Q X + s from the frame in which an obstacle is described (its shape) to its current position.
struct Pose {
  using Rotation = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;
  SpaceVector shift;  ///< s; empty: zero
  Rotation rotation;  ///< Q; empty: the identity

  [[nodiscard]] bool rotates() const { return rotation.size() > 0; }
  /// Returns X for a point in space.
  [[nodiscard]] SpaceVector to_body_frame(SpaceVector position) const {
    if (shift.size() > 0) position -= shift;
    return rotates() ? SpaceVector(rotation.transpose() * position) : position;
  }
  /// Returns x for a point of the obstacle.
  [[nodiscard]] SpaceVector to_space(SpaceVector position) const {
    if (rotates()) position = SpaceVector(rotation * position);
    if (shift.size() > 0) position += shift;
    return position;
  }
  /// Rotates a direction of the obstacle to space.
  [[nodiscard]] SpaceVector direction(const SpaceVector& of_obstacle) const {
    return rotates() ? SpaceVector(rotation * of_obstacle) : of_obstacle;
  }
};

/// Rotation by a vector: angle |θ| about θ. In the plane `vector` has one component, about the third axis. Empty for
/// the zero vector.
[[nodiscard]] Pose::Rotation rotation_by(const SpaceVector& vector, Index dimension);

}  // namespace ricochet
