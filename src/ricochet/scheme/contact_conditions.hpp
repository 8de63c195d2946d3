#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/stage.hpp"
#include "ricochet/scheme/state.hpp"

/// @file The contact conditions that most stages have, and what a finished stage leaves in the state.
namespace ricochet {

/// Every contact point is eligible and y is its gap: y = g₀ + G (base + δ) at `time`.
void require_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage);

/// Coulomb's law on the slip rate w = B_T (velocity + σ δ) − the obstacle's. Does nothing without friction.
void require_friction(const SemidiscreteProblem& problem, const Vector& velocity, const ObstacleMotion& obstacle,
                      double slip_factor, Stage& stage);

/// Reactions and contact status of a solved stage; obstacles moved for `duration` with `obstacle` velocities.
void take_contact(const StageSolution& solution, const ObstacleMotion& obstacle, double duration, State& state);

}  // namespace ricochet
