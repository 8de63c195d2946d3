#include "ricochet/solver/contact/contact_costs.hpp"

#include <algorithm>

namespace ricochet {

namespace {

/// Overhead of a point of a sweep, in entries of W.
constexpr double point_cost = 100.0;
/// Part of a factorization charged to a time step before it is known how long a factor lasts.
constexpr double amortized_factor = 0.125;
/// Weight of the last step in the mean costs.
constexpr double recent = 0.3;

/// Number of unknowns of the Alart–Curnier equations.
double unknown_count(const ContactIteration& iteration) {
  double unknowns = 0.0;
  for (const ContactPoint& point : iteration.system.points()) {
    const PaddedVector r = padded(point, iteration.current.reaction);
    if (!(r[0] > 0.0)) continue;
    const bool slips = point.has_friction() && r.tail<2>().norm() >= point.friction_limit(r[0]) * (1.0 - 1e-9);
    unknowns += double(slips ? point.size - 1 : point.size);
  }
  return unknowns;
}

}  // namespace

double sweep_cost(const ContactIteration& iteration) {
  double closed_rows = 0.0;
  for (const ContactPoint& point : iteration.system.points())
    closed_rows += iteration.current.reaction[point.row] > 0.0 ? double(point.size) : 0.0;
  return std::max(closed_rows, 1.0) * (double(iteration.system.rows()) + point_cost);
}

double newton_cost(const ContactIteration& iteration, bool settled) {
  const double unknowns = unknown_count(iteration);
  const double product = 4.0 * unknowns * double(iteration.system.rows());
  return (settled ? 1.5 : 6.0) * (AlartCurnierStep::factor_work(unknowns) + product) / sweep_cost(iteration);
}

void ContactCosts::update_mean(double& mean, double value) {
  mean = mean > 0.0 ? (1.0 - recent) * mean + recent * value : value;
}

bool ContactCosts::prefer_newton(const ContactIteration& iteration) const {
  if (iteration.system.dense() == nullptr || !(of_sweeps > 0.0)) return false;
  double expected = of_newton;
  if (!(expected > 0.0)) {
    const double unknowns = unknown_count(iteration);
    expected =
        amortized_factor * AlartCurnierStep::factor_work(unknowns) +
        2.0 * (6.0 * unknowns * double(iteration.system.rows()) + 4.0 * AlartCurnierStep::iteration_work(unknowns));
  }
  return expected < of_sweeps;
}

}  // namespace ricochet
