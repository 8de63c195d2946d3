#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"

/// @file The contact conditions that most stages have: one of the first two, which also takes the rows, then friction.
namespace ricochet {

/// The velocities of the obstacles at the contact points, displaced by `displacement`, become those of the stage. If
/// they depend on the position and the stage has conditions at positions (require_no_penetration, which goes first),
/// the solver takes them again at displacement + instant.factor δ: friction then acts relative to the obstacle where
/// the point is, not where it would be without reactions.
void observe_obstacles(const SemidiscreteProblem& problem, const Vector& displacement, const ObstacleInstant& instant,
                       Stage& stage);

/// Every contact point is eligible and y is its gap: y = g₀ + G (base + δ) at `time`; where gaps are not linear,
/// y = g(base + δ) with the rows at base, and the solver takes them again. `start`: the rows are those of the step from
/// there, so that reactions of its end work on its whole motion what they would on a plane.
void require_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage,
                            const StepStart* start = nullptr);

/// Points that touch at `displacement` and `time` do not approach their obstacle, the others carry no force:
/// y = G (velocity + s δ) − the obstacle's, eligible where the gap is not positive. `velocity` is a difference of
/// displacements over `step`, which decides its rounding. The caller sets s. Projects `obstacle` onto the rows.
void require_no_approach(const SemidiscreteProblem& problem, const Vector& displacement, double time,
                         const Vector& velocity, ObstacleMotion& obstacle, double step, Stage& stage);

/// Coulomb's law on the slip rate w = B_T (velocity + σ δ) − the obstacle's, which the stage has. Does nothing without
/// friction.
void require_friction(const SemidiscreteProblem& problem, const Vector& velocity, double slip_factor, Stage& stage);

/// For solvers: rows, velocities of obstacles and offsets at the increment that the stage has given.
void linearize_contact(const SemidiscreteProblem& problem, const Vector& increment, Stage& stage);
/// The largest amounts by which the gaps at this increment are not what the stage's rows say, of points that carry a
/// force and of those that penetrate, beyond the rounding of gaps and beyond that of all terms; and by which obstacles
/// would move otherwise over the step, at points that carry a force. At most 0: the stage is solved, as exactly as its
/// linear conditions are.
struct LinearizationError {
  double beyond_rounding, beyond_all_rounding;
};
[[nodiscard]] LinearizationError linearization_error(const SemidiscreteProblem& problem, const StageSolution& solution,
                                                     Stage& stage, Vector& gap);

}  // namespace ricochet
