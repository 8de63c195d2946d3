#include "ricochet/simulation/restitution.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {
/// A body whose centre comes nearer by less than this, relative to what the impulse changes, does so to rounding.
constexpr double rounding_of_velocity = 1e-9;
/// Below these parts of other speeds the velocity towards an obstacle says nothing of how it was reversed. Spin,
/// vibrations and loads act on the normal velocity itself; sliding only by what friction makes of it.
constexpr double slowest_beside_sliding = 0.01, slowest_beside_others = 0.1;
}  // namespace

std::string why_no_restitution(const Impact& impact) {
  if (!impact.ended) return "the body still touches";
  if (impact.from_inside) return "the body began inside the obstacle, which pushed it out";
  const double approach = -impact.normal_velocity_before();
  if (!(approach > rounding_of_velocity * impact.normal_impulse.norm() / impact.mass))
    return "the body did not come nearer";
  if (approach < slowest_beside_sliding * (impact.tangential_velocity_before() - impact.obstacle_sliding).norm())
    return "the body came nearer at less than 1 % of the speed at which it slid along the obstacle";
  const double energy = impact.before.kinetic_energy - 0.5 * impact.mass * impact.before.velocity.squaredNorm();
  if (approach < slowest_beside_others * std::sqrt(std::max(0.0, 2.0 * energy / impact.mass)))
    return "the body came nearer at less than 10 % of the speed of its spin and vibrations";
  if (approach < slowest_beside_others * std::abs(impact.other_impulse().dot(impact.normal())) / impact.mass)
    return "the body came nearer at less than 10 % of the velocity that other forces gave it during the impact";
  return {};
}

}  // namespace ricochet
