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

RestitutionError restitution_error(const Impact& impact) {
  // A tenth of what the impact has lost, and nothing that the first three digits of e would not show.
  constexpr double large_beside_impact = 0.1, visible = 1e-3;
  const std::optional<double> restitution = impact.restitution();
  if (!restitution || !impact.method_energy) return {};
  const double velocity = impact.normal_velocity_before();
  RestitutionError result;
  result.by_method = *impact.method_energy / (0.5 * impact.mass * velocity * velocity);
  result.by_impact = 1.0 - *restitution * *restitution;
  result.is_large = std::abs(result.by_method) > std::max(visible, large_beside_impact * std::abs(result.by_impact));
  return result;
}

}  // namespace ricochet
