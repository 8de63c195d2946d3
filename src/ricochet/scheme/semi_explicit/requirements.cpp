#include "ricochet/scheme/semi_explicit/requirements.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"

namespace ricochet {

namespace {

/// Of the critical step: above it changes of contact leave high frequencies of large amplitude.
constexpr double safe_fraction = 0.9;

}  // namespace

void require_semi_explicit(const SemidiscreteProblem& problem) {
  require_linear(*problem.internal_force, "scheme \"semi-explicit\"");
  const char* const advice = "set mass.type = \"equivalent-lumped\", or use scheme \"newmark\", which takes any mass";
  if (!problem.mass.is_diagonal()) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("scheme \"semi-explicit\" needs a diagonal mass without inertia on the contact nodes, and "
                            "this one is not diagonal; {}",
                            advice));
  }
  const auto has_inertia = [&](Index dof) { return problem.is_massless[static_cast<std::size_t>(dof)] == 0; };
  if (std::any_of(problem.contact_dofs.begin(), problem.contact_dofs.end(), has_inertia)) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("scheme \"semi-explicit\" needs a mass without inertia on the contact nodes: their motion "
                            "is that of their own equilibrium, contact included; {}",
                            advice));
  }
  if (problem.has_damping() && !is_diagonal(problem.damping)) {
    throw Error(ErrorKind::invalid_input,
                "scheme \"semi-explicit\" takes no damping proportional to the stiffness: it would make the stable "
                "step shorter and need a second product with K; set material damping.stiffness = 0 (damping.mass is "
                "possible), or use scheme \"reduced-kane\"");
  }
}

void check_critical_step(double step, double critical_step) {
  const double fraction = step / critical_step;
  if (fraction >= 1.0) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("scheme \"semi-explicit\": time.step = {:.6g} is {:.3g} times the critical step, "
                            "{:.6g}: the motion would grow without bound; set time.step = {:.3g} or less, or use "
                            "scheme \"reduced-kane\", which is stable for any step",
                            step, fraction, critical_step, safe_fraction * critical_step));
  }
  if (fraction <= safe_fraction) return;
  log::warning(
      fmt::format("scheme \"semi-explicit\": time.step = {:.6g} is {:.3g} of the critical step, {:.6g}; near to it "
                  "changes of contact leave high frequencies of large amplitude, take {:.3g} or less",
                  step, fraction, critical_step, safe_fraction * critical_step));
}

}  // namespace ricochet
