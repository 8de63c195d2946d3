#pragma once

#include <string>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file Requirements of several schemes on a problem and on a time step. All functions throw Error(invalid_input),
/// which names the scheme and the remedy.
namespace ricochet {

/// Requires inertia on contact nodes. `why` completes the sentence: the consequence of contact nodes without inertia.
void require_contact_inertia(const SemidiscreteProblem& problem, const std::string& scheme, const std::string& why);
/// Requires a diagonal mass with inertia at every node and a linear internal force: central differences then solve no
/// system, unless damping is not diagonal.
void require_explicit(const SemidiscreteProblem& problem, const std::string& scheme);
/// Requires a step below the critical one. Warns if the step is nearly as long.
void check_critical_step(const std::string& scheme, double step, double critical_step);

/// Requires support for steps of changing length. `name` begins the message: the feature that needs it, and its scheme.
void require_changing_steps(const Scheme& scheme, const std::string& name);

/// Requires a scheme that relaxes viscoelastic branches if the problem has some. `name` as above.
void require_relaxation(const Scheme& scheme, const SemidiscreteProblem& problem, const std::string& name);

}  // namespace ricochet
