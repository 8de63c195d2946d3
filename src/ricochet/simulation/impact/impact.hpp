#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/simulation/impact/rigid_body.hpp"

/// @file What one impact came to. When there is one, and of which instants its numbers are: impacts.hpp.
namespace ricochet {

/// The other body of an impact of two.
struct OtherBody {
  int number = 0;
  double mass = 0.0;
  RigidMotionState before, after;  ///< `after`: zero where it has not ended
  bool held = false;               ///< RigidBody::held
};

/// Where supports at rest hold one of two bodies and not the other, that one is a part of the ground: the free body's
/// impulse goes through it into the supports, and the motion of its own centre of mass is vibration. Velocities along
/// the normal are then those of the free body alone, as against a wall, and so is the mass of the approach (m₁m₂/(m₁ +
/// m₂) with the ground's m₂ = ∞).
struct Impact {
  int body = 0;
  std::string obstacle;            ///< empty where two bodies met
  std::optional<OtherBody> other;  ///< which takes the opposite of the impulse
  double begin = 0.0, end = 0.0;   ///< where it has not ended: so far
  bool ended = true;
  bool from_start = false;                                   ///< in contact when the run begins
  bool from_inside = false;                                  ///< begins with the run, as the body starts inside
  long intervals = 1;                                        ///< of contact that were taken together
  double contact_time = 0.0;                                 ///< of these alone
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();         ///< of all contact forces on the body
  Eigen::Vector3d normal_impulse = Eigen::Vector3d::Zero();  ///< of their normal parts
  double largest_force = 0.0, largest_force_time = 0.0;      ///< size of the resultant
  long contact_points = 0;                                   ///< most that carried a force at once; 0: not known
  long all_contact_points = 0;                               ///< of this body with this obstacle or body
  std::vector<double> first_place = {};                      ///< reference position of the first contact, if known
  double obstacle_velocity = 0.0;                            ///< along the normal, mean over the normal impulse
  /// Of the obstacle's material across its normal, likewise.
  Eigen::Vector3d obstacle_sliding = Eigen::Vector3d::Zero();
  double mass = 0.0;               ///< of the body
  bool held = false;               ///< RigidBody::held
  RigidMotionState before, after;  ///< `after`: zero where it has not ended
  /// What the discretization of time has put into all bodies meanwhile (EnergyAccount::of_method); negative: it has
  /// taken it away. Of older results it is not known.
  std::optional<double> method_energy = {};
  /// Speed at which the linear law makes the bodies thicker towards each other as they turn, the mean over the impulse
  /// (turn_growth.hpp). 0 where it has not ended, and of older results.
  double turn_growth = 0.0;

  /// Mean direction of the normal impulse, out of the obstacle or the other body; zero without one.
  [[nodiscard]] Eigen::Vector3d normal() const;
  /// Of two bodies: the first, or the other one, is held, and the one that it meets is not.
  [[nodiscard]] bool is_ground() const { return other && held && !other->held; }
  [[nodiscard]] bool other_is_ground() const { return other && other->held && !held; }
  /// Of the centre of mass along the normal, relative to the obstacle or to the other body's; negative: it comes
  /// nearer.
  [[nodiscard]] double normal_velocity_before() const;
  [[nodiscard]] double normal_velocity_after() const;
  /// The mass m for which ½ m v² is the energy of that approach: the body's, of two bodies m₁m₂/(m₁ + m₂) or, where
  /// one is held, the other's.
  [[nodiscard]] double approach_mass() const;
  /// Of the centre of mass, across the normal; not relative to the obstacle or the other body.
  [[nodiscard]] Eigen::Vector3d tangential_velocity_before() const;
  [[nodiscard]] Eigen::Vector3d tangential_velocity_after() const;
  /// −(normal velocity after)/(normal velocity before), where that says something of the impact: restitution.hpp.
  [[nodiscard]] std::optional<double> restitution() const;
  /// Size of the impulse over the time of contact.
  [[nodiscard]] double mean_force() const { return contact_time > 0.0 ? impulse.norm() / contact_time : 0.0; }
  /// So few of many points carry it that one more or less changes the largest force and the duration. A flat end that
  /// strikes with all points it has is not meant.
  [[nodiscard]] bool is_coarse() const {
    return contact_points >= 1 && contact_points <= 3 && contact_points < all_contact_points;
  }
  /// On the body, of loads, supports, damping and all other contacts, in the same steps.
  [[nodiscard]] Eigen::Vector3d other_impulse() const;
  /// The same on the other body; zero where there is none.
  [[nodiscard]] Eigen::Vector3d other_impulse_on_other() const;
};

}  // namespace ricochet
