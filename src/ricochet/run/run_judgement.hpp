#pragma once

#include "ricochet/fem/assembly.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file Warnings about the results of a run.
namespace ricochet {

/// Warns of losses and gains of energy that a user should know of.
void judge_energy(const RunSummary& summary, const Scheme& scheme, const SemidiscreteProblem& problem,
                  const State& state);

/// Warns of steps in which the balance of energy has moved velocities noticeably, with this tolerance of Newton's
/// method.
void judge_velocity_corrections(const RunSummary& summary, double newton_tolerance, const SemidiscreteProblem& problem,
                                const State& state);

/// Warns of contacts between bodies whose force is doubtful after steps that were held.
void judge_unsettled(const RunSummary& summary);

/// Warns of a body with friction and without damping that repeatedly loses contact.
void judge_sliding(const RunSummary& summary, const SemidiscreteProblem& problem, const Body& body);

/// Warns if the largest von Mises stress implies an equivalent strain √(2/3 e:e) = σ/(3μ), e the deviatoric strain,
/// that is not small.
void judge_strain(const RunSummary& summary, const Body& body);

/// Warns of the impact whose restitution is most affected by the growth of a rotating body at small strain.
void judge_rotation_growth(const RunSummary& summary);

/// Returns true if an energy does not exceed the rounding of ½UᵀKU, as that of a body that is merely displaced.
[[nodiscard]] bool is_rounding_of_energy(double energy, const SemidiscreteProblem& problem, const State& state);

}  // namespace ricochet
