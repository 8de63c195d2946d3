#include "ricochet/rigid/free_motion.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;

/// Cross product a × b; for vectors in the plane its third component.
SpaceVector cross(const SpaceVector& a, const SpaceVector& b) {
  if (a.size() == 3) return Vector3(a).cross(Vector3(b));
  return SpaceVector::Constant(1, a[0] * b[1] - a[1] * b[0]);
}

/// Rotates a vector from the principal axes to space; in the plane torques and rotations are unchanged.
SpaceVector to_space(const Pose::Rotation& axes, const SpaceVector& about_axes) {
  return about_axes.size() == 3 ? SpaceVector(axes * about_axes) : about_axes;
}
SpaceVector to_axes(const Pose::Rotation& axes, const SpaceVector& in_space) {
  return in_space.size() == 3 ? SpaceVector(axes.transpose() * in_space) : in_space;
}

}  // namespace

Pose::Rotation cayley(const SpaceVector& rotation) {
  const double square = 0.25 * rotation.squaredNorm(), factor = 1.0 / (1.0 + square);
  if (rotation.size() == 1) {
    const double c = (1.0 - square) * factor, s = rotation[0] * factor;
    Eigen::Matrix2d result;
    result << c, -s, s, c;
    return result;
  }
  Eigen::Matrix3d skew;
  skew << 0.0, -rotation[2], rotation[1], rotation[2], 0.0, -rotation[0], -rotation[1], rotation[0], 0.0;
  return Eigen::Matrix3d::Identity() + factor * (skew + 0.5 * skew * skew);
}

FreeMotion::FreeMotion(Inertia inertia, Index node)
    : inertia_(std::move(inertia)), node_(node), gyration_((inertia_.moments / inertia_.mass).cwiseSqrt()) {
  const Index d = dimension();
  if (inertia_.principal.size() == 0) inertia_.principal = Pose::Rotation::Identity(d, d);
  axes_ = inertia_.principal;
  rotation_at_start_ = SpaceVector::Zero(gyration_.size());
}

SpaceVector FreeMotion::step_rotation(const Vector& displacement) const {
  const SpaceVector now = displacement.segment(rotation_node() * dimension(), gyration_.size());
  return (now - rotation_at_start_).cwiseQuotient(gyration_);
}

void FreeMotion::begin_step(const Vector& displacement) {
  const SpaceVector now = displacement.segment(rotation_node() * dimension(), gyration_.size());
  if (now == rotation_at_start_) return;
  axes_ = axes(displacement);
  rotation_at_start_ = now;
  // A product of rotations is a rotation only up to rounding errors, which accumulate.
  if (dimension() == 3) {
    const Eigen::Quaterniond unit(Eigen::Matrix3d{axes_});
    axes_ = unit.normalized().toRotationMatrix();
  } else {
    axes_ /= std::sqrt(axes_(0, 0) * axes_(0, 0) + axes_(1, 0) * axes_(1, 0));
  }
}

void FreeMotion::persist(const SnapshotVisitor& visit) {
  visit.numbers("axes", axes_);
  visit.numbers("turned", rotation_at_start_);
}

Pose::Rotation FreeMotion::axes(const Vector& displacement) const {
  const SpaceVector rotation = step_rotation(displacement);
  return rotation.isZero(0.0) ? axes_ : Pose::Rotation(axes_ * cayley(rotation));
}

SpaceVector FreeMotion::centre(const Vector& displacement) const {
  return inertia_.centre + displacement.segment(node_ * dimension(), dimension());
}

Pose FreeMotion::pose(const Vector& displacement) const {
  Pose result;
  result.rotation = axes(displacement) * inertia_.principal.transpose();
  result.shift = centre(displacement) - result.rotation * inertia_.centre;
  return result;
}

void FreeMotion::write_row(const SpaceVector& direction, const SpaceVector& arm, const Pose::Rotation& axes,
                           double* row) const {
  for (const double n : direction) *row++ = n;
  const SpaceVector lever = to_axes(axes, cross(arm, direction)).cwiseQuotient(gyration_);
  for (const double l : lever) *row++ = l;
  if (dimension() == 2) *row = 0.0;
}

SpaceVector FreeMotion::torque(const Vector& force) const {
  const SpaceVector own = force.segment(rotation_node() * dimension(), gyration_.size());
  return to_space(axes_, own.cwiseProduct(gyration_));
}

SpaceVector FreeMotion::torque(const SpaceVector& arm, const Vector& force) const {
  return cross(arm, force.segment(centre_node() * dimension(), dimension()));
}

void FreeMotion::add_torque(const SpaceVector& torque, Vector& force) const {
  force.segment(rotation_node() * dimension(), gyration_.size()) += to_axes(axes_, torque).cwiseQuotient(gyration_);
}

SpaceVector FreeMotion::angular_momentum(const Vector& displacement, const Vector& velocity) const {
  const SpaceVector own = velocity.segment(rotation_node() * dimension(), gyration_.size());
  return to_space(axes(displacement), inertia_.mass * own.cwiseProduct(gyration_));
}

SpaceVector FreeMotion::velocity_of_momentum(const SpaceVector& momentum, const Vector& displacement) const {
  const SpaceVector own = to_axes(axes(displacement), momentum).cwiseQuotient(inertia_.mass * gyration_);
  SpaceVector result = SpaceVector::Zero(dimension());
  result.head(own.size()) = own;
  return result;
}

SpaceVector FreeMotion::angular_velocity(const Vector& displacement, const Vector& velocity) const {
  const SpaceVector own = velocity.segment(rotation_node() * dimension(), gyration_.size());
  return to_space(axes(displacement), own.cwiseQuotient(gyration_));
}

SpaceVector FreeMotion::rotational_velocity(const SpaceVector& spin, const Vector& displacement) const {
  const SpaceVector own = to_axes(axes(displacement), spin).cwiseProduct(gyration_);
  SpaceVector result = SpaceVector::Zero(dimension());
  result.head(own.size()) = own;
  return result;
}

/// g = (1 − ½Θ^)⁻¹ [2J(Θ − hW₀) + Θ × JΘ]/h² − 2J(Θ − hW₀)/h².
void FreeMotion::add_gyroscopic_force(const Vector& end, const Vector& velocity, double step, Vector& force) const {
  if (!has_gyroscopic_force()) return;
  const Vector3 rotation = step_rotation(end), moments = inertia_.moments;
  const Vector3 spin = Vector3(velocity.segment<3>(rotation_node() * 3)).cwiseQuotient(Vector3(gyration_));
  const Vector3 linear = 2.0 * moments.cwiseProduct(rotation - step * spin);
  const Vector3 sum = linear + rotation.cross(Vector3(moments.cwiseProduct(rotation)));
  // (1 − ½Θ^)⁻¹ v = (v + ½Θ×v + ¼Θ(Θ·v))/(1 + ¼Θ²)
  const Vector3 solved =
      (sum + 0.5 * rotation.cross(sum) + 0.25 * rotation.dot(sum) * rotation) / (1.0 + 0.25 * rotation.squaredNorm());
  force.segment<3>(rotation_node() * 3) -= 1.0 / (step * step) * (solved - linear).cwiseQuotient(Vector3(gyration_));
}

}  // namespace ricochet
