#pragma once

#include <string>

#include "ricochet/scheme/reduced/massless_layer.hpp"

namespace ricochet {

/// For schemes whose balance of energy holds without friction, against planes, and without stiffness damping at contact
/// nodes. Throws Error(invalid_input) that says what to use.
void require_frictionless_planes(const SemidiscreteProblem& problem, const MasslessLayer& layer,
                                 const std::string& scheme);

}  // namespace ricochet
