#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/stage.hpp"

/// @file Contact conditions common to most stages: first require_no_penetration or require_no_approach, which also
/// updates the rows, then require_friction.
namespace ricochet {

/// Sets the obstacle velocities of the stage to those at the contact points displaced by `displacement`. If they depend
/// on the position and the stage has conditions at positions (require_no_penetration, which is called first), the
/// solver re-evaluates them at displacement + instant.factor δ: friction then acts relative to the obstacle at the
/// position of the point, not at the position it would have without reactions.
void evaluate_obstacle_velocity(const SemidiscreteProblem& problem, const Vector& displacement,
                                const ObstacleInstant& instant, Stage& stage);

/// Makes every contact point eligible, with its gap as y: y = g₀ + G (base + δ) at `time`; if gaps are not
/// linear, y = g(base + δ) with the rows at base, and the solver relinearizes them. With `start`, the rows are
/// those of the step from there, so that the reactions at its end do the work on the whole motion of the step
/// that they would do on a plane.
void require_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage,
                            const StepStart* start = nullptr);

/// Requires that points in contact at `displacement` and `time` do not approach their obstacle; all others carry
/// no force: y = G (velocity + s δ) − the obstacle's velocity, eligible if the gap is not positive. `velocity`
/// is a difference of displacements over `step`, which determines its rounding error. The caller sets s.
/// Projects `obstacle` onto the rows.
void require_no_approach(const SemidiscreteProblem& problem, const Vector& displacement, double time,
                         const Vector& velocity, ObstacleMotion& obstacle, double step, Stage& stage);

/// Imposes Coulomb's law on the slip rate w = B_T (velocity + σ δ) − the obstacle velocity of the stage. Does nothing
/// without friction.
void require_friction(const SemidiscreteProblem& problem, const Vector& velocity, double slip_factor, Stage& stage);

/// Relinearizes a stage for solvers: rows, obstacle velocities and offsets at the given increment of the stage.
void linearize_contact(const SemidiscreteProblem& problem, const Vector& increment, Stage& stage);
/// Linearization error of the gaps at an increment: the largest differences between the actual gaps and those that the
/// rows of the stage predict, at points that carry a force or penetrate, in excess of the rounding of the gaps and in
/// excess of the rounding of all terms; at points that carry a force also the change of the obstacle motion over the
/// step. If at most 0, the stage is solved as exactly as its linear conditions are.
struct LinearizationError {
  double beyond_rounding, beyond_all_rounding;
};
[[nodiscard]] LinearizationError linearization_error(const SemidiscreteProblem& problem, const StageSolution& solution,
                                                     Stage& stage, Vector& gap);

}  // namespace ricochet
