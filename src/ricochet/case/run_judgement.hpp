#pragma once

#include "ricochet/io/summary.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file What a run says of itself.
namespace ricochet {

/// Warns of what the account of energy says that a user should hear.
void judge_energy(const RunSummary& summary, const SemidiscreteProblem& problem, const State& state);

/// Is an energy no more than what ½UᵀKU is rounded to? That of a body that is merely displaced is.
[[nodiscard]] bool is_rounding_of_energy(double energy, const SemidiscreteProblem& problem, const State& state);

}  // namespace ricochet
