#pragma once

#include "ricochet/base/space_vector.hpp"

/// @file Where a rigid obstacle is.
namespace ricochet {

/// x = Q X + s takes a point of the obstacle as it is described (its shape) to where it is.
struct Pose {
  using Rotation = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;
  SpaceVector shift;  ///< s; empty: zero
  Rotation rotation;  ///< Q; empty: the identity

  [[nodiscard]] bool turns() const { return rotation.size() > 0; }
  /// X of a point of space.
  [[nodiscard]] SpaceVector seen_from(SpaceVector position) const {
    if (shift.size() > 0) position -= shift;
    return turns() ? SpaceVector(rotation.transpose() * position) : position;
  }
  /// x of a point of the obstacle.
  [[nodiscard]] SpaceVector in_space(SpaceVector position) const {
    if (turns()) position = SpaceVector(rotation * position);
    if (shift.size() > 0) position += shift;
    return position;
  }
  /// The same of a direction.
  [[nodiscard]] SpaceVector direction(const SpaceVector& of_obstacle) const {
    return turns() ? SpaceVector(rotation * of_obstacle) : of_obstacle;
  }
};

/// The rotation by a vector: |θ| about θ. In the plane `vector` has one component, about the third axis. By zero:
/// empty.
[[nodiscard]] Pose::Rotation rotation_by(const SpaceVector& vector, Index dimension);

}  // namespace ricochet
