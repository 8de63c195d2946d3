#pragma once

#include <memory>
#include <utility>

#include "ricochet/rigid/free_motion.hpp"
#include "ricochet/rigid/obstacle_path.hpp"
#include "ricochet/rigid/obstacle_shape.hpp"
#include "ricochet/rigid/pose.hpp"

/// @file Rigid obstacles: a shape (obstacle_shape.hpp) with a pose at each instant.
namespace ricochet {

/// An obstacle in its pose at an instant. Refers to its shape.
class PosedObstacle {
 public:
  PosedObstacle(const ObstacleShape& shape, Pose pose) : shape_(&shape), pose_(std::move(pose)) {}
  [[nodiscard]] const Pose& pose() const { return pose_; }
  /// Signed distance to the surface, positive where bodies may be, and the unit normal towards them.
  [[nodiscard]] double gap(const SpaceVector& position) const { return shape_->gap(pose_.to_body_frame(position)); }
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const {
    return pose_.direction(shape_->normal(pose_.to_body_frame(position)));
  }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const;

 private:
  friend SpaceVector normal_of_step(const PosedObstacle&, const SpaceVector&, const PosedObstacle&, const SpaceVector&);
  const ObstacleShape* shape_;
  Pose pose_;
};

/// Returns the motion from the first pose to the second of the material point that the mean of both poses maps to x̄ in
/// space: ΔQ Q̄⁻¹(x̄ − s̄) + Δs. For rotations close to half a turn or beyond, Q̄⁻¹ does not exist; then returns the
/// motion of the point that the second pose maps to x̄.
[[nodiscard]] SpaceVector motion_at(const Pose& start, const Pose& end, const SpaceVector& middle);
/// Angle by which an obstacle in `dimension` dimensions rotates between two poses, from 0 to π.
[[nodiscard]] double rotation_angle_between(const Pose& start, const Pose& end, Index dimension);
/// Returns a unit normal n for an obstacle at two instants and a point that moves from one position to another, such
/// that with some a > 0
///   n·(Δx − v) = a (gap₁ − gap₀),
/// where v is the obstacle's own motion at the mean of both positions (motion_at). If the obstacle does not rotate, n
/// is the normal of its shape (ObstacleShape::normal_of_step). Otherwise, with X the position of the point relative to
/// the obstacle and N the shape's normal at the mean X̄, n has the direction of Q̄N plus a correction along Δx − v, as
/// there.
[[nodiscard]] SpaceVector normal_of_step(const PosedObstacle& start, const SpaceVector& from, const PosedObstacle& end,
                                         const SpaceVector& to);

class Obstacle {
 public:
  /// `path`: null at rest. `spin`: rate at which its material moves along its own surface, about its own axis. `about`:
  /// the point whose displacement is that of the path; empty: the shape's centre, if it has one. `time_scale`: instants
  /// closer than a thousandth of it have the same velocity.
  explicit Obstacle(std::unique_ptr<ObstacleShape> shape, std::unique_ptr<const ObstaclePath> path = {},
                    double spin = 0.0, const Vector& about = {}, double time_scale = 1.0);

  [[nodiscard]] const ObstacleShape& shape() const { return *shape_; }
  void fit(const ContactScale& scale) { shape_->fit(scale); }
  /// Free motion under the forces on it, which then determines its pose `at` a displacement. Null: the path does.
  [[nodiscard]] FreeMotion* free_motion() const { return free_.get(); }
  void set_free(std::shared_ptr<FreeMotion> motion) { free_ = std::move(motion); }
  /// Its path if a program steers it, else null.
  [[nodiscard]] SteeredPath* steered_path() const { return steered_; }
  void set_steered(std::unique_ptr<SteeredPath> path);
  /// The obstacle in its pose at a time and a displacement of the problem.
  [[nodiscard]] PosedObstacle at(double time, const Vector& displacement) const {
    return {*shape_, free_ != nullptr ? free_->pose(displacement) : pose(time)};
  }
  /// Pose at a time, for an obstacle that does not move freely, or for the start.
  [[nodiscard]] PosedObstacle at(double time) const { return {*shape_, pose(time)}; }
  /// At t = 0.
  [[nodiscard]] double gap(const SpaceVector& position) const { return at(0.0).gap(position); }
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const { return at(0.0).normal(position); }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const { return at(0.0).gap_rounding(position); }

  /// Whether gaps are linear functions of the position with constant normals: those of t = 0 minus n·translation(t).
  [[nodiscard]] bool has_constant_normals() const {
    return shape_->is_flat() && free_ == nullptr && (path_ == nullptr || !path_->rotates());
  }
  [[nodiscard]] double least_radius() const { return shape_->least_radius(); }
  /// Checksum of the files that define it; empty if none.
  [[nodiscard]] std::string checksum() const {
    return shape_->checksum() + (path_ != nullptr ? path_->checksum() : std::string());
  }
  /// Whether its material has a prescribed motion.
  [[nodiscard]] bool moves() const { return path_ != nullptr || spin_ != 0.0; }
  [[nodiscard]] bool spins() const { return spin_ != 0.0; }
  /// Whether its poses at two instants differ by more than a translation.
  [[nodiscard]] bool rotates() const { return path_ != nullptr && path_->rotates(); }
  /// Returns u(t) − u(0).
  [[nodiscard]] SpaceVector translation(double time) const;
  [[nodiscard]] Pose pose(double time) const;
  /// Velocity of the obstacle's material at a position: its mean over [time − span/2, time + span/2], or for span = 0
  /// its value at the time.
  [[nodiscard]] SpaceVector surface_velocity(const SpaceVector& position, double time, double span = 0.0) const;

  /// For pictures: the surface at t = 0, within `radius` of its point nearest to `centre`.
  [[nodiscard]] ObstacleSurface surface(const Vector& centre, double radius) const;
  /// For pictures: positions at which points of `surface` are shown at a time and a displacement. Those of a plane stay
  /// beside the body when the plane moves along itself, and rotate with a turntable.
  [[nodiscard]] Points surface_points(const Points& at_start, double time, const Vector& displacement = {}) const;

 private:
  [[nodiscard]] SpaceVector spin_velocity(const SpaceVector& position, double time) const;

  std::unique_ptr<ObstacleShape> shape_;
  std::unique_ptr<const ObstaclePath> path_;
  SteeredPath* steered_ = nullptr;  ///< path_ if it is steered
  std::shared_ptr<FreeMotion> free_;
  double spin_;
  SpaceVector axis_;   ///< of the spin, in 3D
  SpaceVector about_;  ///< c
  double time_scale_;
};

/// Makes an obstacle of a type, at rest or with a constant velocity.
[[nodiscard]] std::unique_ptr<Obstacle> make_obstacle(const std::string& type, Parameters parameters,
                                                      const Vector& velocity = {}, double spin = 0.0);
/// Makes a plane at rest; `normal` points out of the obstacle and has any length but zero.
[[nodiscard]] std::unique_ptr<Obstacle> make_plane(const Vector& point, const Vector& normal);

}  // namespace ricochet
