#include "ricochet/simulation/history/sensor.hpp"

namespace ricochet {

namespace {

bool carries(const Vector& normal, const Vector& tangential, Index point) {
  if (normal[point] != 0.0) return true;
  if (tangential.size() == 0) return false;
  const Index tangents = tangential.size() / normal.size();
  return !tangential.segment(point * tangents, tangents).isZero(0.0);
}

}  // namespace

bool carries_force(const StepForces& forces, Index point) {
  return carries(forces.normal_reaction, forces.tangential_reaction, point);
}

bool carries_acting_force(const StepForces& forces, Index point) {
  return carries(forces.acting_normal(), forces.acting_tangential(), point);
}

}  // namespace ricochet
