#include "ricochet/scheme/reduced/requirements.hpp"

#include <fmt/format.h>

#include "ricochet/base/error.hpp"

namespace ricochet {

void require_frictionless_planes(const SemidiscreteProblem& problem, const MasslessLayer& layer,
                                 const std::string& scheme) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorKind::invalid_input, fmt::format("scheme \"{}\" {}; use scheme \"reduced-kane\"", scheme, what));
  };
  if (problem.contact.has_friction()) refuse("takes no friction: its balance of energy has no sign with it");
  if (problem.contact.follows_motion()) refuse("takes planes only: it needs gaps that are linear in the motion");
  if (layer.damps_contact_nodes())
    refuse("takes no stiffness damping at contact nodes, whose place must be a function of the others'");
}

}  // namespace ricochet
