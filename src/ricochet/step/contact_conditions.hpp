#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/stage.hpp"

/// @file Contact conditions common to most stages. The order matters:
///   1. require_no_penetration or require_no_approach, which also updates the rows;
///   2. require_friction, which is relative to the obstacle velocities of the stage.
/// If obstacles move, evaluate_obstacle_velocity comes before 2. If it comes after require_no_penetration, the solver
/// re-evaluates the velocities; it comes before require_no_approach, which needs its result. No function throws an
/// Error.
namespace ricochet {

/// Sets the obstacle velocities of the stage to those at the contact points displaced by `displacement`. If they depend
/// on the position and the stage has conditions at positions (require_no_penetration), the solver re-evaluates them at
/// displacement + instant.factor δ: friction then acts relative to the obstacle at the position of the point, not at
/// the position it would have without reactions. If no obstacle moves, all velocities stay empty.
void evaluate_obstacle_velocity(const SemidiscreteProblem& problem, const Vector& displacement,
                                const ObstacleInstant& instant, Stage& stage);

/// Makes every contact point eligible, with its gap as y and s = 1: y = g₀ + G (base + δ) at `time`; if gaps are not
/// linear, y = g(base + δ) with the rows at base, and the solver relinearizes them. With `start`, the rows are those of
/// the step from there: the work of the reactions at its end on the whole motion of the step is then that on a plane.
void require_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage,
                            const StepStart* start = nullptr);

/// Begins the same conditions for gaps that are not linear, but does not evaluate them at δ = 0: after
/// require_friction, linearize_contact completes the conditions of the stage at another increment.
void prepare_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage,
                            const StepStart* start = nullptr);

/// Requires that points in contact at `displacement` and `time` do not approach their obstacle; all others carry
/// no force: y = G (velocity + gap_factor δ) − the obstacle's velocity, eligible if the gap is not positive. `velocity`
/// is a difference of displacements over `step`, which determines its rounding error. Projects `obstacle` onto the
/// rows.
void require_no_approach(const SemidiscreteProblem& problem, const Vector& displacement, double time,
                         const Vector& velocity, double gap_factor, ObstacleMotion& obstacle, double step,
                         Stage& stage);

/// Imposes Coulomb's law on the slip rate w = B_T (velocity + slip_factor δ) − the obstacle velocity of the stage;
/// slip_factor is 1/time. Uses this velocity up. Throws std::logic_error if obstacles move and their velocity has not
/// been evaluated since the last call. Does nothing in a problem without friction, whose stages never have a slip.
void require_friction(const SemidiscreteProblem& problem, const Vector& velocity, double slip_factor, Stage& stage);

/// Relinearizes a stage for solvers: rows, obstacle velocities and offsets at the given increment of the stage.
void linearize_contact(const SemidiscreteProblem& problem, const Vector& increment, Stage& stage);
/// Largest |actual − predicted gap|, as the rows of the stage predict it, over the points that carry a force, and over
/// those that penetrate; for points that carry a force also the change of the obstacle motion over the step. If at most
/// 0, the stage is solved as exactly as its linear conditions are.
struct LinearizationError {
  double beyond_rounding;      ///< less the rounding of the gaps
  double beyond_all_rounding;  ///< less the rounding of all terms
};
/// Computes these errors at an increment, over all ranks. `gap` is work space.
[[nodiscard]] LinearizationError linearization_error(const SemidiscreteProblem& problem, const StageSolution& solution,
                                                     Stage& stage, Vector& gap);

}  // namespace ricochet
