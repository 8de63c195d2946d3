#pragma once

#include "ricochet/solver/contact/globalized_newton.hpp"

/// @file What sweeps and Newton's method cost, in entries of matrices that are read: counted, never taken by a clock.
namespace ricochet {

/// Of a sweep: what the points that are closed now read, and what they cost besides.
[[nodiscard]] double sweep_work(const ContactWork& work);
/// What Newton would cost from here, in sweeps; `settled`: the states of the points change no more.
[[nodiscard]] double newton_cost(const ContactWork& work, bool settled);

/// What problems have cost, on the mean of recent ones: zero, not known yet.
struct ContactCosts {
  double of_sweeps = 0.0, of_newton = 0.0;

  static void learn(double& mean, double value);
  /// From the last reactions: Newton with the factor of an earlier step has cost less than sweeps, or promises to.
  [[nodiscard]] bool prefer_newton(const ContactWork& work) const;
};

}  // namespace ricochet
