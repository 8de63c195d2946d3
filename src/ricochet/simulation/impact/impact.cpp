#include "ricochet/simulation/impact/impact.hpp"

#include "ricochet/simulation/impact/restitution.hpp"

namespace ricochet {

Eigen::Vector3d Impact::normal() const {
  const double size = normal_impulse.norm();
  return size > 0.0 ? Eigen::Vector3d(normal_impulse / size) : Eigen::Vector3d::Zero();
}

double Impact::normal_velocity_before() const {
  const double own = is_ground() ? 0.0 : before.velocity.dot(normal());
  if (other_is_ground()) return own;
  return own - (other ? other->before.velocity.dot(normal()) : obstacle_velocity);
}

double Impact::normal_velocity_after() const {
  const double own = is_ground() ? 0.0 : after.velocity.dot(normal());
  if (other_is_ground()) return own;
  return own - (other ? other->after.velocity.dot(normal()) : obstacle_velocity);
}

double Impact::approach_mass() const {
  if (is_ground()) return other->mass;
  if (other_is_ground()) return mass;
  return other ? mass * other->mass / (mass + other->mass) : mass;
}

Eigen::Vector3d Impact::tangential_velocity_before() const {
  return before.velocity - before.velocity.dot(normal()) * normal();
}

Eigen::Vector3d Impact::tangential_velocity_after() const {
  return after.velocity - after.velocity.dot(normal()) * normal();
}

std::optional<double> Impact::restitution() const {
  if (!why_no_restitution(*this).empty()) return {};
  return normal_velocity_after() / -normal_velocity_before();
}

Eigen::Vector3d Impact::other_impulse() const {
  return ended ? Eigen::Vector3d(mass * (after.velocity - before.velocity) - impulse) : Eigen::Vector3d::Zero();
}

Eigen::Vector3d Impact::other_impulse_on_other() const {
  if (!ended || !other) return Eigen::Vector3d::Zero();
  return other->mass * (other->after.velocity - other->before.velocity) + impulse;
}

}  // namespace ricochet
