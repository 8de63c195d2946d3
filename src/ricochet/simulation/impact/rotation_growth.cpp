#include "ricochet/simulation/impact/rotation_growth.hpp"

#include <cmath>

namespace ricochet {

double rotation_growth(const RotatingBody& body, const Eigen::Vector3d& outward, double duration) {
  // Rate of −½ φ × (φ × a) · n = ½ (φ² a·n − (φ·a) (φ·n)), for the rotation φ and the spin that changes it.
  const auto rate = [&](const Eigen::Vector3d& rotation, const Eigen::Vector3d& spin) {
    return rotation.dot(spin) * body.arm.dot(outward) -
           0.5 * (rotation.dot(body.arm) * spin.dot(outward) + spin.dot(body.arm) * rotation.dot(outward));
  };
  // With the fraction s = ½ (1 − cos(πt/T)) of the impulse the spin is ω + s Δ, and the rotation is its integral. Means
  // over s: of s and of t/T 1/2, of s t/T 5/16, of sin(πt/T) π/4, of s sin(πt/T) π/8.
  const Eigen::Vector3d change = body.spin_after - body.spin_before;
  return rate(body.rotation, body.spin_before + 0.5 * change) +
         duration * (0.5 * rate(body.spin_before, body.spin_before) + 7.0 / 16.0 * rate(body.spin_before, change) +
                     3.0 / 32.0 * rate(change, change));
}

double restitution_excess(const Impact& impact) {
  if (impact.rotation_growth == 0.0 || !impact.restitution()) return 0.0;
  return 2.0 * impact.rotation_growth / -impact.normal_velocity_before();
}

bool is_distorted_by_rotation(const Impact& impact) {
  return std::abs(restitution_excess(impact)) > restitution_excess_limit;
}

}  // namespace ricochet
