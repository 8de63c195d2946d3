#pragma once

#include <memory>
#include <utility>

#include "ricochet/rigid/free_motion.hpp"
#include "ricochet/rigid/obstacle_path.hpp"
#include "ricochet/rigid/obstacle_shape.hpp"
#include "ricochet/rigid/pose.hpp"

/// @file Rigid obstacles: a shape (obstacle_shape.hpp) that is somewhere at each instant.
namespace ricochet {

/// An obstacle where it is at an instant. Refers to its shape.
class PlacedObstacle {
 public:
  PlacedObstacle(const ObstacleShape& shape, Pose pose) : shape_(&shape), pose_(std::move(pose)) {}
  [[nodiscard]] const Pose& pose() const { return pose_; }
  /// Signed distance to the surface, positive where bodies may be, and the unit normal towards them.
  [[nodiscard]] double gap(const SpaceVector& position) const { return shape_->gap(pose_.seen_from(position)); }
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const {
    return pose_.direction(shape_->normal(pose_.seen_from(position)));
  }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const;

 private:
  friend SpaceVector normal_of_step(const PlacedObstacle&, const SpaceVector&, const PlacedObstacle&,
                                    const SpaceVector&);
  const ObstacleShape* shape_;
  Pose pose_;
};

/// Where the mean of two poses has a point, from the first to the second it moves by ΔQ Q̄⁻¹(x̄ − s̄) + Δs, x̄ in space.
/// For a rotation of half a turn and more there is no such point; it moves then as the one that is seen there at the
/// end.
[[nodiscard]] SpaceVector motion_at(const Pose& start, const Pose& end, const SpaceVector& middle);
/// The angle by which an obstacle in `dimension` dimensions has turned between two poses, from 0 to π.
[[nodiscard]] double turn_between(const Pose& start, const Pose& end, Index dimension);
/// Of the same obstacle at two instants, and of a point that goes from one place to another: a unit normal n such that,
/// with some a > 0,
///   n·(Δx − v) = a (gap₁ − gap₀),
/// v the obstacle's own motion at the mean of both places (motion_at). Where the obstacle does not turn it is that of
/// its shape (ObstacleShape::normal_of_step); else with X where the point is seen from the obstacle and N the shape's
/// normal at the mean X̄, the direction of Q̄N and what is missing along Δx − v, as there.
[[nodiscard]] SpaceVector normal_of_step(const PlacedObstacle& start, const SpaceVector& from,
                                         const PlacedObstacle& end, const SpaceVector& to);

class Obstacle {
 public:
  /// `path`: null at rest. `spin`: its material moves along its own surface, at this rate about its own axis.
  /// `about`: the point whose displacement is that of the path; empty: the shape's centre, if it has one. `time_scale`:
  /// instants that are nearer than a thousandth of it see the same velocity.
  explicit Obstacle(std::unique_ptr<ObstacleShape> shape, std::unique_ptr<const ObstaclePath> path = {},
                    double spin = 0.0, const Vector& about = {}, double time_scale = 1.0);

  [[nodiscard]] const ObstacleShape& shape() const { return *shape_; }
  void fit(const ContactScale& scale) { shape_->fit(scale); }
  /// Moves by the forces on it: `place` of a step then says where it is. Null: its path says it.
  [[nodiscard]] FreeMotion* free_motion() const { return free_.get(); }
  void set_free(std::shared_ptr<FreeMotion> motion) { free_ = std::move(motion); }
  /// Its motion, where a program sets it; else null.
  [[nodiscard]] SteeredPath* steered_path() const { return steered_; }
  void set_steered(std::unique_ptr<SteeredPath> path);
  /// Where it is at a time and a displacement of the problem.
  [[nodiscard]] PlacedObstacle at(double time, const Vector& displacement) const {
    return {*shape_, free_ != nullptr ? free_->pose(displacement) : pose(time)};
  }
  /// The same of an obstacle that does not move freely, or at the start.
  [[nodiscard]] PlacedObstacle at(double time) const { return {*shape_, pose(time)}; }
  /// At t = 0.
  [[nodiscard]] double gap(const SpaceVector& position) const { return at(0.0).gap(position); }
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const { return at(0.0).normal(position); }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const { return at(0.0).gap_rounding(position); }

  /// Gaps are linear functions of the position whose normals never change: those of t = 0 less n·translation(t).
  [[nodiscard]] bool has_constant_normals() const {
    return shape_->is_flat() && free_ == nullptr && (path_ == nullptr || !path_->turns());
  }
  [[nodiscard]] double least_radius() const { return shape_->least_radius(); }
  /// Of the files that it comes from; empty: none.
  [[nodiscard]] std::string checksum() const {
    return shape_->checksum() + (path_ != nullptr ? path_->checksum() : std::string());
  }
  /// Whether its material moves as the case says.
  [[nodiscard]] bool moves() const { return path_ != nullptr || spin_ != 0.0; }
  [[nodiscard]] bool spins() const { return spin_ != 0.0; }
  /// Whether its places at two instants then differ by more than a displacement.
  [[nodiscard]] bool turns() const { return path_ != nullptr && path_->turns(); }
  /// u(t) − u(0).
  [[nodiscard]] SpaceVector translation(double time) const;
  [[nodiscard]] Pose pose(double time) const;
  /// Velocity of the obstacle's material that is at a position at that time: its mean over [time − span/2,
  /// time + span/2], or for span = 0 that at the time.
  [[nodiscard]] SpaceVector surface_velocity(const SpaceVector& position, double time, double span = 0.0) const;

  /// For pictures: the surface at t = 0, as far as `radius` around its point nearest to `centre`.
  [[nodiscard]] ObstacleSurface surface(const Vector& centre, double radius) const;
  /// For pictures: where points of `surface` are shown at a time and a displacement. Those of a plane stay beside the
  /// body when the plane moves along itself, and turn with a turntable.
  [[nodiscard]] Points surface_points(const Points& at_start, double time, const Vector& displacement = {}) const;

 private:
  [[nodiscard]] SpaceVector spin_velocity(const SpaceVector& position, double time) const;

  std::unique_ptr<ObstacleShape> shape_;
  std::unique_ptr<const ObstaclePath> path_;
  SteeredPath* steered_ = nullptr;  ///< path_, where it is one
  std::shared_ptr<FreeMotion> free_;
  double spin_;
  SpaceVector axis_;   ///< of the spin, in 3D
  SpaceVector about_;  ///< c
  double time_scale_;
};

/// Of one type, at rest or with a constant velocity.
[[nodiscard]] std::unique_ptr<Obstacle> make_obstacle(const std::string& type, Parameters parameters,
                                                      const Vector& velocity = {}, double spin = 0.0);
/// A plane at rest; `normal` of any length but zero, out of the obstacle.
[[nodiscard]] std::unique_ptr<Obstacle> make_plane(const Vector& point, const Vector& normal);

}  // namespace ricochet
