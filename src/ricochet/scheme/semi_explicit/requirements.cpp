#include "ricochet/scheme/semi_explicit/requirements.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"

namespace ricochet {

void require_semi_explicit(const SemidiscreteProblem& problem, const std::string& scheme) {
  const char* const advice =
      "set mass.type = \"equivalent-lumped\", or use scheme \"newmark\", which supports any mass";
  if (!problem.has_diagonal_mass()) {
    throw Error(ErrorKind::invalid_input, fmt::format("scheme \"{}\" needs a diagonal mass without inertia on the "
                                                      "contact nodes, but this one is not diagonal; {}",
                                                      scheme, advice));
  }
  if (problem.pressure) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("scheme \"{}\" does not support a [[pressure]] that follows the surface; use scheme "
                            "\"reduced-kane\" or \"newmark\", or a [[traction]], which keeps its direction",
                            scheme));
  }
  const auto has_inertia = [&](Index dof) { return problem.is_massless[std::size_t(dof)] == 0; };
  if (std::ranges::any_of(problem.contact_dofs, has_inertia)) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("scheme \"{}\" needs a mass without inertia on the contact nodes: their motion follows "
                            "from their own equilibrium, contact included; {}",
                            scheme, advice));
  }
  if (problem.damping.has_stiffness_part()) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("scheme \"{}\" does not support damping proportional to the stiffness: it would shorten "
                            "the stable step and require a second product with K; set material damping.stiffness = 0 "
                            "(damping.mass is supported), or use scheme \"reduced-kane\"",
                            scheme));
  }
}

}  // namespace ricochet
