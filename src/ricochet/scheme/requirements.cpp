#include "ricochet/scheme/requirements.hpp"

#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/rounded.hpp"

namespace ricochet {

/// Fraction of the critical step above which changes of contact leave high frequencies of large amplitude.
constexpr double safe_fraction = 0.9;

void require_contact_inertia(const SemidiscreteProblem& problem, const std::string& scheme, const std::string& why) {
  if (!problem.has_singular_mass()) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("scheme \"{}\" needs inertia on the contact nodes: {}; set mass.type = \"consistent\" (or "
                          "\"lumped\"), or use scheme \"reduced-kane\" with this mass",
                          scheme, why));
}

void require_explicit(const SemidiscreteProblem& problem, const std::string& scheme) {
  require_linear(*problem.internal_force, "scheme \"" + scheme + "\"");
  if (!problem.has_singular_mass() && problem.has_diagonal_mass()) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("scheme \"{}\" is explicit and needs a diagonal mass with inertia at every node; set "
                          "mass.type = \"lumped\", or use scheme \"reduced-kane\", which supports the equivalent mass",
                          scheme));
}

void require_changing_steps(const Scheme& scheme, const std::string& name) {
  if (scheme.traits().supports_step_changes) return;
  throw Error(ErrorKind::invalid_input, fmt::format("{} uses the previous step and cannot change the length of steps; "
                                                    "set time.step to a number, or use scheme \"reduced-kane\"",
                                                    name));
}

void require_relaxation(const Scheme& scheme, const SemidiscreteProblem& problem, const std::string& name) {
  if (problem.internal_force->viscous() == nullptr || scheme.traits().supports_relaxation) return;
  throw Error(ErrorKind::invalid_input, name +
                                            " does not support viscoelastic branches: use scheme \"reduced-kane\", "
                                            "\"mean-reaction\" or \"reduced-midpoint\", or remove material.relaxation");
}

void check_critical_step(const std::string& scheme, double step, double critical_step) {
  const double fraction = step / critical_step;
  if (fraction >= 1.0) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("scheme \"{}\": time.step = {:.6g} is {:.3g} times the critical step, {:.6g}: the motion "
                            "would grow without bound; set time.step = {:.3g} or less, or use scheme "
                            "\"reduced-kane\", which is stable for any step",
                            scheme, step, fraction, critical_step, rounded_down(safe_fraction * critical_step, 3)));
  }
  if (fraction <= safe_fraction) return;
  log::warning(
      fmt::format("scheme \"{}\": time.step = {:.6g} is {:.3g} of the critical step, {:.6g}; close to it changes of "
                  "contact cause high frequencies of large amplitude, set time.step = {:.3g} or less",
                  scheme, step, fraction, critical_step, rounded_down(safe_fraction * critical_step, 3)));
}

}  // namespace ricochet
