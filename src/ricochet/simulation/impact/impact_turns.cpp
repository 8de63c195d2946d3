#include "ricochet/simulation/impact/impacts.hpp"
#include "ricochet/simulation/impact/turn_growth.hpp"

/// @file How far bodies have turned when an impact begins, and what that does to it.
namespace ricochet {

/// One of the mesh with the linear law. The mean rotation of a body that supports hold is bending, and no turn of it.
bool ImpactRecorder::grows_as_it_turns(int body) const {
  const auto count = static_cast<int>(rigid_.bodies().size() - problem_.free_bodies.size());
  return problem_.internal_force->is_linear() && body >= 0 && body < count &&
         !rigid_.bodies()[static_cast<std::size_t>(body)].held;
}

/// At the beginning of the step. What rigid_ says of the velocity is overwritten, and asked for anew.
void ImpactRecorder::take_turns(Interval& interval) {
  const Place& place = places_[static_cast<std::size_t>(interval.place)];
  if (!problem_.internal_force->is_linear()) return;
  // Of the displacement as if it were a velocity: its mean, and its mean rotation.
  const std::vector<RigidMotionState>& moved = rigid_.motion(displacement_before_, displacement_before_);
  const auto at = [&](int body) -> const RigidMotionState& { return moved[static_cast<std::size_t>(body)]; };
  const auto centre = [&](int body) -> const Eigen::Vector3d& {
    return rigid_.bodies()[static_cast<std::size_t>(body)].centre;
  };
  Eigen::Vector3d::Map(interval.turn.data()) = at(place.body).spin;
  if (grows_as_it_turns(place.other)) {
    const Eigen::Vector3d arm = Eigen::Vector3d::Map(interval.first_place.data()) - centre(place.body);
    const Eigen::Vector3d contact = centre(place.body) + at(place.body).velocity + arm + at(place.body).spin.cross(arm);
    Eigen::Vector3d::Map(interval.other_turn.data()) = at(place.other).spin;
    Eigen::Vector3d::Map(interval.other_arm.data()) = contact - centre(place.other) - at(place.other).velocity;
  }
  motion_ = &rigid_.motion(velocity_before_, displacement_before_);
}

/// Of an impact that has ended.
double ImpactRecorder::growth_in(const Interval& interval, const Impact& impact) const {
  const Place& place = places_[static_cast<std::size_t>(interval.place)];
  const double duration = impact.end - impact.begin;
  double growth = 0.0;
  if (grows_as_it_turns(place.body)) {
    const Eigen::Vector3d& centre = rigid_.bodies()[static_cast<std::size_t>(place.body)].centre;
    growth += turn_growth({Eigen::Vector3d::Map(interval.turn.data()), impact.before.spin, impact.after.spin,
                           Eigen::Vector3d::Map(interval.first_place.data()) - centre},
                          -impact.normal(), duration);
  }
  if (impact.other && grows_as_it_turns(place.other)) {
    growth += turn_growth({Eigen::Vector3d::Map(interval.other_turn.data()), impact.other->before.spin,
                           impact.other->after.spin, Eigen::Vector3d::Map(interval.other_arm.data())},
                          impact.normal(), duration);
  }
  return growth;
}

}  // namespace ricochet
