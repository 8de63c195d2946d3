#include "ricochet/simulation/impact/impacts.hpp"
#include "ricochet/simulation/impact/rotation_growth.hpp"

/// @file Rotation of bodies at the start of an impact, and its effect on the impact.
namespace ricochet {

/// True for bodies of the mesh with the linear law that supports do not hold: the mean rotation of a held body is
/// bending.
bool ImpactRecorder::inflates_with_rotation(int body) const {
  const auto count = int(rigid_.bodies().size() - problem_.free_bodies.size());
  return problem_.internal_force->is_linear() && body >= 0 && body < count && !rigid_.bodies()[std::size_t(body)].held;
}

/// Uses the state at the start of the step. Overwrites the motion of rigid_, which is therefore computed anew.
void ImpactRecorder::compute_rotations(Interval& interval) {
  const CollisionPair& collision = collision_pairs_[interval.collision];
  if (!problem_.internal_force->is_linear()) return;
  // The displacement is treated as a velocity, which yields its mean and its mean rotation.
  const std::vector<RigidMotionState>& moved = rigid_.motion(displacement_before_, displacement_before_);
  const auto at = [&](int body) -> const RigidMotionState& { return moved[std::size_t(body)]; };
  const auto centre = [&](int body) -> const Eigen::Vector3d& { return rigid_.bodies()[std::size_t(body)].centre; };
  interval.rotation = at(collision.body).spin;
  if (inflates_with_rotation(collision.other)) {
    const Eigen::Vector3d arm = interval.first_position - centre(collision.body);
    const Eigen::Vector3d contact =
        centre(collision.body) + at(collision.body).velocity + arm + at(collision.body).spin.cross(arm);
    interval.other_rotation = at(collision.other).spin;
    interval.other_arm = contact - centre(collision.other) - at(collision.other).velocity;
  }
  motion_ = &rigid_.motion(velocity_before_, displacement_before_);
}

/// Sums the growth of both bodies in an impact that has ended.
double ImpactRecorder::growth_in(const Interval& interval, const Impact& impact) const {
  const CollisionPair& collision = collision_pairs_[interval.collision];
  const double duration = impact.end - impact.begin;
  double growth = 0.0;
  if (inflates_with_rotation(collision.body)) {
    const Eigen::Vector3d& centre = rigid_.bodies()[std::size_t(collision.body)].centre;
    growth +=
        rotation_growth({interval.rotation, impact.before.spin, impact.after.spin, interval.first_position - centre},
                        -impact.normal(), duration);
  }
  if (impact.other && inflates_with_rotation(collision.other)) {
    growth += rotation_growth(
        {interval.other_rotation, impact.other->before.spin, impact.other->after.spin, interval.other_arm},
        impact.normal(), duration);
  }
  return growth;
}

}  // namespace ricochet
