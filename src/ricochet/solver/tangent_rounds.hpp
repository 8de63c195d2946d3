#pragma once

#include "ricochet/linear_algebra/anderson_acceleration.hpp"
#include "ricochet/solver/stage/stage_solver.hpp"

/// @file Contact conditions that follow the motion.
namespace ricochet {

/// Solves a stage with tangent planes at the solution of the round before, until they leave no more than rounding in
/// the gaps. Each round would square the error if forces did not turn with the normals; they do, and the error changes
/// by their size times the surface's curvature over the stiffness of the step: by little mostly, by a half in a hard
/// impact, and it grows where a step is long for the force that it needs. So the rounds are accelerated where
/// they do not settle by themselves.
class TangentRounds {
 public:
  explicit TangentRounds(const SemidiscreteProblem& problem);
  /// From a stage that was solved once. Throws Error(not_converged).
  void follow_motion(StageSolver& solver, Stage& stage, StageSolution& solution);

 private:
  void linearize_at(const Vector& increment, bool accelerate);

  const SemidiscreteProblem& problem_;
  Vector gap_;
  AndersonAcceleration acceleration_{12};
  Vector linearized_at_;  ///< increment
  Vector point_, image_;  ///< of a round, on contact dofs
};

}  // namespace ricochet
