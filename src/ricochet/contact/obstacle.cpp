#include "ricochet/contact/obstacle.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Of instants between which an instantaneous velocity is taken, relative to the time scale.
constexpr double instant_of_scale = 1e-3;

/// rate about an axis, times an arm; in the plane the axis is the third one.
SpaceVector rate_times_arm(double rate, const SpaceVector& axis, const SpaceVector& arm) {
  if (arm.size() == 2) return rate * Eigen::Vector2d(-arm[1], arm[0]);
  return rate * Eigen::Vector3d(axis).cross(Eigen::Vector3d(arm));
}

/// The direction of Q̄⁻ᵀ N. A rotation between the two is less than half a turn, or Q̄ has no inverse.
SpaceVector mean_direction(const Pose::Rotation& mean, const SpaceVector& normal) {
  SpaceVector result;
  if (normal.size() == 2) {
    result = Eigen::Matrix2d(mean.transpose()).inverse() * Eigen::Vector2d(normal);
  } else {
    result = Eigen::Matrix3d(mean.transpose()).inverse() * Eigen::Vector3d(normal);
  }
  return result.normalized();
}

}  // namespace

double PlacedObstacle::gap_rounding(const SpaceVector& position) const {
  const double moved = pose_.shift.size() > 0 ? pose_.shift.lpNorm<1>() : 0.0;
  return shape_->gap_rounding(pose_.seen_from(position)) +
         eight_roundings(moved + (pose_.turns() ? position.lpNorm<1>() : 0.0));
}

SpaceVector normal_of_step(const PlacedObstacle& start, const SpaceVector& from, const PlacedObstacle& end,
                           const SpaceVector& to) {
  const SpaceVector own = end.shape_->normal_of_step(start.pose_.seen_from(from), end.pose_.seen_from(to));
  if (!end.pose_.turns() && !start.pose_.turns()) return own;
  const auto rotation = [&](const PlacedObstacle& placed) {
    return placed.pose_.turns() ? placed.pose_.rotation
                                : Pose::Rotation(Pose::Rotation::Identity(to.size(), to.size()));
  };
  const Pose::Rotation first = rotation(start), last = rotation(end);
  constexpr double half_turn = 0.1;
  // The least singular value of Q̄ is the cosine of half the angle between the two, at the traces that they have.
  const double trace = (first.transpose() * last).trace();
  const double cosine = to.size() == 2 ? 0.5 * trace : 0.5 * (trace - 1.0);
  if (0.5 * (1.0 + cosine) < half_turn * half_turn) return last * own;
  return mean_direction(0.5 * (first + last), own);
}

Obstacle::Obstacle(std::unique_ptr<ObstacleShape> shape, std::unique_ptr<const ObstaclePath> path, double spin,
                   const Vector& about, double time_scale)
    : shape_(std::move(shape)), path_(std::move(path)), spin_(spin), about_(about), time_scale_(time_scale) {
  if (about_.size() == 0) about_ = shape_->centre();
  if (about_.size() == 0)
    throw Error(ErrorKind::invalid_input, "an obstacle that is in two dimensions or three needs a point");
  const ObstacleShape::OwnAxis own = shape_->own_axis();
  axis_ = own.direction;
  if (spin_ != 0.0 && !own.exists)
    throw Error(ErrorKind::invalid_input,
                "it has no axis about which it could turn without another surface: give its rotation in place of a "
                "rotation_rate");
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
  if (!path_->turns()) return result;
  result.rotation = rotation_by(path_->rotation(time), about_.size());
  if (result.turns()) result.shift += about_ - result.rotation * about_;
  return result;
}

SpaceVector Obstacle::spin_velocity(const SpaceVector& position, double time) const {
  if (spin_ == 0.0) return SpaceVector::Zero(position.size());
  return rate_times_arm(spin_, axis_, position - shape_->centre() - translation(time));
}

/// Of the point that is X on the shape.
SpaceVector Obstacle::mean_velocity(const SpaceVector& of_shape, double start, double end) const {
  return (pose(end).in_space(of_shape) - pose(start).in_space(of_shape)) / (end - start);
}

SpaceVector Obstacle::surface_velocity(const SpaceVector& position, double time, double span) const {
  SpaceVector result = spin_velocity(position, time);
  if (path_ == nullptr) return result;
  if (path_->is_uniform()) return result + path_->velocity();
  const SpaceVector of_shape = pose(time).seen_from(position);
  if (span > 0.0) return result + mean_velocity(of_shape, time - 0.5 * span, time + 0.5 * span);
  const double near = instant_of_scale * time_scale_;
  if (time >= near) return result + mean_velocity(of_shape, time - near, time + near);
  // Expressions are not asked for what was before the start.
  return result + 2.0 * mean_velocity(of_shape, time, time + near) - mean_velocity(of_shape, time, time + 2.0 * near);
}

SpaceVector Obstacle::velocity_of_step(const SpaceVector& from, double from_time, const SpaceVector& to,
                                       double to_time) const {
  const SpaceVector middle = 0.5 * (from + to);
  SpaceVector result = spin_velocity(middle, 0.5 * (from_time + to_time));
  if (path_ == nullptr) return result;
  if (path_->is_uniform()) return result + path_->velocity();
  return result +
         mean_velocity(0.5 * (pose(from_time).seen_from(from) + pose(to_time).seen_from(to)), from_time, to_time);
}

ObstacleSurface Obstacle::surface(const Vector& centre, double radius) const {
  const Pose start = pose(0.0);
  ObstacleSurface result = shape_->surface(start.seen_from(centre), radius);
  for (auto point : result.points.colwise()) point = start.in_space(SpaceVector(point));
  return result;
}

Points Obstacle::surface_points(const Points& at_start, double time) const {
  Points result = at_start;
  if (has_constant_normals()) {
    const SpaceVector up = normal(about_);
    const SpaceVector lift = translation(time).dot(up) * up;
    if (spin_ != 0.0 && axis_.size() == 3) {
      const Eigen::Vector3d middle = at_start.rowwise().mean();
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(spin_ * time, Eigen::Vector3d(axis_)).toRotationMatrix();
      result = (turn * (at_start.colwise() - middle)).colwise() + middle;
    }
    return result.colwise() + Vector(lift);
  }
  if (path_ == nullptr) return result;
  const Pose start = pose(0.0), now = pose(time);
  for (auto point : result.colwise()) point = now.in_space(start.seen_from(SpaceVector(point)));
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
