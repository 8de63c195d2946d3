#include "ricochet/rigid/pose.hpp"

#include <Eigen/Geometry>

namespace ricochet {

Pose::Rotation rotation_by(const SpaceVector& vector, Index dimension) {
  const double angle = vector.stableNorm();
  if (angle == 0.0) return {};
  if (dimension == 2) return Eigen::Rotation2Dd(vector[0]).toRotationMatrix();
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(vector) / angle).toRotationMatrix();
}

}  // namespace ricochet
