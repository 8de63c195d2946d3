#pragma once

#include "ricochet/fem/assembly.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file What a run says of itself.
namespace ricochet {

/// Warns of what the account of energy says that a user should hear.
void judge_energy(const RunSummary& summary, const Scheme& scheme, const SemidiscreteProblem& problem,
                  const State& state);

/// Warns of contacts between bodies whose force held steps have put in doubt.
void judge_unsettled(const RunSummary& summary);

/// Warns of a body with friction and without damping that loses contact again and again.
void judge_sliding(const RunSummary& summary, const SemidiscreteProblem& problem, const Body& body);

/// Warns where the largest von Mises stress goes with an equivalent strain √(2/3 e:e) = σ/(3μ), e the deviatoric
/// strain, that is not small.
void judge_strain(const RunSummary& summary, const Body& body);

/// Warns of the impact whose restitution is changed most by the turn of a body that small strain makes grow.
void judge_turning(const RunSummary& summary);

/// Is an energy no more than what ½UᵀKU is rounded to? That of a body that is merely displaced is.
[[nodiscard]] bool is_rounding_of_energy(double energy, const SemidiscreteProblem& problem, const State& state);

}  // namespace ricochet
