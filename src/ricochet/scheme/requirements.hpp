#pragma once

#include <string>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file What several schemes ask of a problem and of a time step. All throw Error(invalid_input), which names the
/// scheme and says what to do.
namespace ricochet {

/// No mass without inertia on contact nodes; `why`: what would happen with one, the rest of a sentence.
void require_contact_inertia(const SemidiscreteProblem& problem, const std::string& scheme, const std::string& why);
/// A diagonal mass with inertia at every node, no damping that is not diagonal, a linear internal force: what central
/// differences need that solve no system.
void require_explicit(const SemidiscreteProblem& problem, const std::string& scheme);
/// A step below the critical one. Warns of one that is nearly as long.
void check_critical_step(const std::string& scheme, double step, double critical_step);

/// Steps whose length changes. `name` is the beginning of the message: what asks, and for which scheme.
void require_changing_steps(const Scheme& scheme, const std::string& name);

/// A scheme that relaxes the stress of branches, where the problem has some. `name` as above.
void require_relaxation(const Scheme& scheme, const SemidiscreteProblem& problem, const std::string& name);

}  // namespace ricochet
