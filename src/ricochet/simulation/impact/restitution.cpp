#include "ricochet/simulation/impact/restitution.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

/// Approach velocity, relative to the change by the impulse, below which it is rounding.
constexpr double rounding_of_velocity = 1e-9;
/// Fractions of other speeds below which the approach velocity does not determine how it is reversed. Spin, vibrations
/// and loads act on the normal velocity itself, sliding only through friction.
constexpr double slowest_beside_sliding = 0.01, slowest_beside_others = 0.1;

namespace {

/// Twice the energy of spin and vibrations over the mass: the square of their speed. The whole motion of a held body is
/// vibration.
double squared_speed_of_others(double mass, const RigidMotionState& motion, bool is_ground) {
  const double of_centre = is_ground ? 0.0 : 0.5 * mass * motion.velocity.squaredNorm();
  const double energy = motion.kinetic_energy - of_centre;
  return std::max(0.0, 2.0 * energy / mass);
}

/// Speed of spin and vibrations, of both bodies if there are two.
double speed_of_others(const Impact& impact) {
  double squared = squared_speed_of_others(impact.mass, impact.before, impact.is_ground());
  if (impact.other)
    squared += squared_speed_of_others(impact.other->mass, impact.other->before, impact.other_is_ground());
  return std::sqrt(squared);
}

/// Speed across the normal, relative to the obstacle or the other body.
double sliding_speed(const Impact& impact) {
  Eigen::Vector3d sliding = -impact.obstacle_sliding;
  if (!impact.is_ground()) sliding += impact.tangential_velocity_before();
  if (impact.other && !impact.other_is_ground()) {
    const Eigen::Vector3d& others = impact.other->before.velocity;
    sliding -= others - others.dot(impact.normal()) * impact.normal();
  }
  return sliding.norm();
}

/// Velocity along the normal, of two bodies the relative one: forces that accelerate both alike do not contribute.
double velocity_by_other_forces(const Impact& impact) {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (!impact.is_ground()) velocity += impact.other_impulse() / impact.mass;
  if (impact.other && !impact.other_is_ground()) velocity -= impact.other_impulse_on_other() / impact.other->mass;
  return std::abs(velocity.dot(impact.normal()));
}

}  // namespace

std::string why_no_restitution(const Impact& impact) {
  const bool two = impact.other.has_value();
  if (!impact.ended) return two ? "the bodies still touch" : "the body still touches";
  if (impact.from_inside) {
    return two ? "the bodies overlapped at the start, and were pushed apart"
               : "the body began inside the obstacle, which pushed it out";
  }
  const std::string came = two ? "the bodies came nearer " : "the body came nearer ";
  const double approach = -impact.normal_velocity_before();
  if (!(approach > rounding_of_velocity * impact.normal_impulse.norm() / impact.approach_mass()))
    return two ? "the bodies did not come nearer" : "the body did not come nearer";
  if (approach < slowest_beside_sliding * sliding_speed(impact)) {
    return came + (two ? "at less than 1 % of the speed at which they slid along each other"
                       : "at less than 1 % of the speed at which it slid along the obstacle");
  }
  if (approach < slowest_beside_others * speed_of_others(impact)) {
    return came + (two ? "at less than 10 % of the speed of their spins and vibrations"
                       : "at less than 10 % of the speed of its spin and vibrations");
  }
  if (approach < slowest_beside_others * velocity_by_other_forces(impact)) {
    return came + (two ? "at less than 10 % of the velocity that other forces gave them during the impact"
                       : "at less than 10 % of the velocity that other forces gave it during the impact");
  }
  return {};
}

std::string restitution_doubt(const Impact& impact) {
  constexpr double rounding = 1e-3;  // of the method: a rebound without losses, or without any, may differ by as much
  const std::optional<double> restitution = impact.restitution();
  if (!restitution || (*restitution >= -rounding && *restitution <= 1.0 + rounding)) return "";
  if (*restitution > 1.0)
    return restitution_error(impact).is_large
               ? ""
               : "above 1: energy of deformation or rotation has become that of the rebound";
  return impact.other ? "their centres still approach each other after the last force"
                      : "its centre still approaches the obstacle after the last force";
}

RestitutionError restitution_error(const Impact& impact) {
  // Large is a tenth of the loss in the impact, but nothing that the first three digits of e do not show.
  constexpr double large_beside_impact = 0.1, visible = 1e-3;
  const std::optional<double> restitution = impact.restitution();
  if (!restitution) return {};
  const double velocity = impact.normal_velocity_before();
  RestitutionError result;
  result.by_method = impact.method_energy / (0.5 * impact.approach_mass() * velocity * velocity);
  result.by_impact = 1.0 - *restitution * *restitution;
  result.is_large = std::abs(result.by_method) > std::max(visible, large_beside_impact * std::abs(result.by_impact));
  return result;
}

}  // namespace ricochet
