#pragma once

#include "ricochet/solver/contact/globalized_newton.hpp"

/// @file Costs of sweeps and of Newton's method, in matrix entries that are read: counted, never measured.
namespace ricochet {

/// Cost of a sweep: entries read for the points that are closed now, and overhead per point.
[[nodiscard]] double sweep_cost(const ContactIteration& iteration);
/// Cost of Newton's method from here, in sweeps; `settled`: the states of the points no longer change.
[[nodiscard]] double newton_cost(const ContactIteration& iteration, bool settled);

/// Costs of problems, averaged over recent ones: zero if not known yet.
struct ContactCosts {
  double of_sweeps = 0.0, of_newton = 0.0;

  static void update_mean(double& mean, double value);
  /// True if, from the last reactions, Newton's method with the factor of an earlier step has cost less than sweeps, or
  /// promises to.
  [[nodiscard]] bool prefer_newton(const ContactIteration& iteration) const;
};

}  // namespace ricochet
