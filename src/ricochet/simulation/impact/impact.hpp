#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/simulation/impact/rigid_body.hpp"

/// @file Results of one impact. The definition of an impact and the instants of its numbers: impacts.hpp.
namespace ricochet {

/// Other body of an impact between two bodies.
struct OtherBody {
  int number = 0;
  double mass = 0.0;
  RigidMotionState before, after;  ///< `after`: zero if the impact has not ended
  bool held = false;               ///< RigidBody::held
};

/// If supports at rest hold one of two bodies and not the other, the held one is a part of the ground: the free body's
/// impulse passes through it into the supports, and the motion of its own centre of mass is vibration. Velocities along
/// the normal are then those of the free body alone, as against a wall, and so is the mass of the approach (m₁m₂/(m₁ +
/// m₂) with the ground's m₂ = ∞).
struct Impact {
  int body = 0;
  std::string obstacle;            ///< empty for two bodies
  std::optional<OtherBody> other;  ///< receives the opposite impulse
  double begin = 0.0, end = 0.0;   ///< `end`: so far, if the impact has not ended
  bool ended = true;
  bool from_start = false;                                   ///< in contact when the run begins
  bool from_inside = false;                                  ///< begins with the run, since the body starts inside
  long intervals = 1;                                        ///< number of contact intervals that are combined
  double contact_time = 0.0;                                 ///< duration of these intervals
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();         ///< of all contact forces on the body
  Eigen::Vector3d normal_impulse = Eigen::Vector3d::Zero();  ///< of their normal parts
  double largest_force = 0.0, largest_force_time = 0.0;      ///< magnitude of the resultant
  long contact_points = 0;                                   ///< largest number with a force at once
  long all_contact_points = 0;                               ///< of this body with this obstacle or body
  std::vector<double> first_position = {};                   ///< reference position of the first contact, if known
  double obstacle_velocity = 0.0;                            ///< along the normal, mean over the normal impulse
  /// Velocity of the obstacle's material across its normal, likewise.
  Eigen::Vector3d obstacle_sliding = Eigen::Vector3d::Zero();
  double mass = 0.0;               ///< of the body
  bool held = false;               ///< RigidBody::held
  RigidMotionState before, after;  ///< `after`: zero if the impact has not ended
  /// Energy that the time discretization has put into all bodies meanwhile (EnergyAccount::method_energy), negative if
  /// it has removed energy.
  double method_energy = 0.0;
  /// Speed at which the linear law makes the bodies grow towards each other as they rotate, mean over the impulse
  /// (rotation_growth.hpp). 0 if the impact has not ended.
  double rotation_growth = 0.0;

  /// Mean direction of the normal impulse, out of the obstacle or the other body; zero without an impulse.
  [[nodiscard]] Eigen::Vector3d normal() const;
  /// Returns whether, of two bodies, the first or the other one is held and its partner is not.
  [[nodiscard]] bool is_ground() const { return other && held && !other->held; }
  [[nodiscard]] bool other_is_ground() const { return other && other->held && !held; }
  /// Velocity of the centre of mass along the normal, relative to the obstacle or the other body's; negative if the
  /// distance decreases.
  [[nodiscard]] double normal_velocity_before() const;
  [[nodiscard]] double normal_velocity_after() const;
  /// Mass m for which ½ m v² is the energy of this approach: that of the body; for two bodies m₁m₂/(m₁ + m₂) or, if one
  /// is held, that of the other.
  [[nodiscard]] double approach_mass() const;
  /// Velocity of the centre of mass across the normal, not relative to the obstacle or the other body.
  [[nodiscard]] Eigen::Vector3d tangential_velocity_before() const;
  [[nodiscard]] Eigen::Vector3d tangential_velocity_after() const;
  /// −(normal velocity after)/(normal velocity before), if it characterizes the impact: restitution.hpp.
  [[nodiscard]] std::optional<double> restitution() const;
  /// Magnitude of the impulse over the time of contact.
  [[nodiscard]] double mean_force() const { return contact_time > 0.0 ? impulse.norm() / contact_time : 0.0; }
  /// Returns whether the impact is carried by so few of many points that one more or less changes the largest force and
  /// the duration. A flat end that strikes with all its points is not coarse.
  [[nodiscard]] bool is_coarse() const {
    return contact_points >= 1 && contact_points <= 3 && contact_points < all_contact_points;
  }
  /// Impulse on the body of loads, supports, damping and all other contacts, in the same steps.
  [[nodiscard]] Eigen::Vector3d other_impulse() const;
  /// Likewise for the other body; zero if there is none.
  [[nodiscard]] Eigen::Vector3d other_impulse_on_other() const;
};

}  // namespace ricochet
