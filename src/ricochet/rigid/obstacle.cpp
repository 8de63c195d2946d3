#include "ricochet/rigid/obstacle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Half the interval over which an instantaneous velocity is averaged, relative to the time scale.
constexpr double instant_of_scale = 1e-3;

/// Product of a rate about an axis and an arm; in the plane the axis is the third one.
SpaceVector rate_times_arm(double rate, const SpaceVector& axis, const SpaceVector& arm) {
  if (arm.size() == 2) return rate * Eigen::Vector2d(-arm[1], arm[0]);
  return rate * Eigen::Vector3d(axis).cross(Eigen::Vector3d(arm));
}

Pose::Rotation rotation_of(const Pose& pose, Index dimension) {
  return pose.rotates() ? pose.rotation : Pose::Rotation(Pose::Rotation::Identity(dimension, dimension));
}
SpaceVector shift_of(const Pose& pose, Index dimension) {
  return pose.shift.size() > 0 ? pose.shift : SpaceVector(SpaceVector::Zero(dimension));
}

SpaceVector solve(const Pose::Rotation& matrix, const SpaceVector& right) {
  if (right.size() == 2) return Eigen::Matrix2d(matrix).inverse() * Eigen::Vector2d(right);
  return Eigen::Matrix3d(matrix).inverse() * Eigen::Vector3d(right);
}

/// Squared cosine of half the angle between two rotations; the cosine is the smallest singular value of their mean.
double half_cosine(const Pose::Rotation& first, const Pose::Rotation& last) {
  const double trace = (first.transpose() * last).trace();
  return 0.5 * (1.0 + (first.rows() == 2 ? 0.5 * trace : 0.5 * (trace - 1.0)));
}
constexpr double least_half_cosine = 0.01;

}  // namespace

double PosedObstacle::gap_rounding(const SpaceVector& position) const {
  const double moved = pose_.shift.size() > 0 ? pose_.shift.lpNorm<1>() : 0.0;
  return shape_->gap_rounding(pose_.to_body_frame(position)) +
         eight_roundings(moved + (pose_.rotates() ? position.lpNorm<1>() : 0.0));
}

double rotation_angle_between(const Pose& start, const Pose& end, Index dimension) {
  if (!start.rotates() && !end.rotates()) return 0.0;
  const double squared = half_cosine(rotation_of(start, dimension), rotation_of(end, dimension));
  return 2.0 * std::acos(std::sqrt(std::clamp(squared, 0.0, 1.0)));
}

SpaceVector motion_at(const Pose& start, const Pose& end, const SpaceVector& middle) {
  const Index d = middle.size();
  const SpaceVector before = shift_of(start, d), after = shift_of(end, d);
  if (!start.rotates() && !end.rotates()) return after - before;
  const Pose::Rotation first = rotation_of(start, d), last = rotation_of(end, d);
  const SpaceVector of_shape = half_cosine(first, last) < least_half_cosine
                                   ? end.to_body_frame(middle)
                                   : solve(0.5 * (first + last), middle - 0.5 * (before + after));
  return (last - first) * of_shape + after - before;
}

SpaceVector normal_of_step(const PosedObstacle& start, const SpaceVector& from, const PosedObstacle& end,
                           const SpaceVector& to) {
  const ObstacleShape& shape = *end.shape_;
  const SpaceVector reference_before = start.pose_.to_body_frame(from), reference_after = end.pose_.to_body_frame(to);
  if (!end.pose_.rotates() && !start.pose_.rotates()) return shape.normal_of_step(reference_before, reference_after);
  const Pose::Rotation first = rotation_of(start.pose_, to.size()), last = rotation_of(end.pose_, to.size());
  const SpaceVector at_start = first * shape.normal(reference_before), at_end = last * shape.normal(reference_after);
  const SpaceVector middle = shape.gradient(0.5 * (reference_before + reference_after));
  const SpaceVector own = middle.norm() * ((first + last) * middle).normalized();
  const SpaceVector relative_step = to - from - motion_at(start.pose_, end.pose_, 0.5 * (from + to));
  const double change = shape.gap(reference_after) - shape.gap(reference_before);
  const double rounding = start.gap_rounding(from) + end.gap_rounding(to);
  return corrected_normal(own, relative_step, change, rounding, at_start, at_end);
}

Obstacle::Obstacle(std::unique_ptr<ObstacleShape> shape, std::unique_ptr<const ObstaclePath> path, double spin,
                   const Vector& about, double time_scale)
    : shape_(std::move(shape)), path_(std::move(path)), spin_(spin), about_(about), time_scale_(time_scale) {
  if (about_.size() == 0) about_ = shape_->centre();
  if (about_.size() == 0)
    throw Error(ErrorKind::invalid_input, "an obstacle that exists in two dimensions and in three requires a point");
  const ObstacleShape::SymmetryAxis own = shape_->symmetry_axis();
  axis_ = own.direction;
  if (spin_ != 0.0 && !own.exists)
    throw Error(ErrorKind::invalid_input,
                "it has no axis about which it could turn without changing its surface: set its rotation instead of a "
                "rotation_rate");
}

void Obstacle::set_steered(std::unique_ptr<SteeredPath> path) {
  steered_ = path.get();
  path_ = std::move(path);
}

SpaceVector Obstacle::translation(double time) const {
  if (path_ == nullptr) return SpaceVector::Zero(about_.size());
  if (path_->is_uniform()) return time * path_->velocity();
  return path_->displacement(time) - path_->displacement(0.0);
}

Pose Obstacle::pose(double time) const {
  Pose result;
  if (path_ == nullptr) return result;
  result.shift = path_->is_uniform() ? SpaceVector(time * path_->velocity()) : path_->displacement(time);
  if (!path_->rotates()) return result;
  result.rotation = rotation_by(path_->rotation(time), about_.size());
  if (result.rotates()) result.shift += about_ - result.rotation * about_;
  return result;
}

SpaceVector Obstacle::spin_velocity(const SpaceVector& position, double time) const {
  if (spin_ == 0.0) return SpaceVector::Zero(position.size());
  return rate_times_arm(spin_, axis_, position - shape_->centre() - translation(time));
}

SpaceVector Obstacle::surface_velocity(const SpaceVector& position, double time, double span) const {
  SpaceVector result = spin_velocity(position, time);
  if (path_ == nullptr) return result;
  if (path_->is_uniform()) return result + path_->velocity();
  const auto mean = [&](double start, double end) -> SpaceVector {
    return motion_at(pose(start), pose(end), position) / (end - start);
  };
  if (span > 0.0) return result + mean(time - 0.5 * span, time + 0.5 * span);
  const double near = instant_of_scale * time_scale_;
  if (time >= near) return result + mean(time - near, time + near);
  // Expressions are not evaluated before the start. A velocity smaller than the difference of the two means counts as
  // zero: for an obstacle that starts from rest it would be a rounding error, whose direction friction would treat as
  // that of sliding.
  const SpaceVector first = mean(time, time + near), both = mean(time, time + 2.0 * near);
  const SpaceVector velocity = 2.0 * first - both;
  if (velocity.norm() <= 2.0 * (both - first).norm()) return result;
  return result + velocity;
}

ObstacleSurface Obstacle::surface(const Vector& centre, double radius) const {
  const Pose start = pose(0.0);
  ObstacleSurface result = shape_->surface(start.to_body_frame(centre), radius);
  for (auto point : result.points.colwise()) point = start.to_space(SpaceVector(point));
  return result;
}

Points Obstacle::surface_points(const Points& at_start, double time, const Vector& displacement) const {
  Points result = at_start;
  if (free_ != nullptr) {
    const Pose now = free_->pose(displacement);
    for (auto point : result.colwise()) point = now.to_space(SpaceVector(point));
    return result;
  }
  if (has_constant_normals()) {
    const SpaceVector up = normal(about_);
    const SpaceVector lift = translation(time).dot(up) * up;
    if (spin_ != 0.0 && axis_.size() == 3) {
      const Eigen::Vector3d middle = at_start.rowwise().mean();
      const Eigen::Matrix3d rotation = Eigen::AngleAxisd(spin_ * time, Eigen::Vector3d(axis_)).toRotationMatrix();
      result = (rotation * (at_start.colwise() - middle)).colwise() + middle;
    }
    return result.colwise() + Vector(lift);
  }
  if (path_ == nullptr) return result;
  const Pose start = pose(0.0), now = pose(time);
  for (auto point : result.colwise()) point = now.to_space(start.to_body_frame(SpaceVector(point)));
  return result;
}

std::unique_ptr<Obstacle> make_obstacle(const std::string& type, Parameters parameters, const Vector& velocity,
                                        double spin) {
  return std::make_unique<Obstacle>(make_obstacle_shape(type, std::move(parameters)), make_uniform_path(velocity),
                                    spin);
}

std::unique_ptr<Obstacle> make_plane(const Vector& point, const Vector& normal) {
  const auto numbers = [](const Vector& v) { return std::vector<double>(v.begin(), v.end()); };
  return make_obstacle("plane", {{"point", numbers(point)}, {"normal", numbers(normal)}});
}

}  // namespace ricochet
