#pragma once

#include "ricochet/linear_algebra/anderson_acceleration.hpp"
#include "ricochet/solver/stage/stage_solver.hpp"
#include "ricochet/step/thresholds.hpp"

/// @file Contact conditions that follow the motion.
namespace ricochet {

/// Solves a stage with tangent planes at the previous solution, until the linearization error of the gaps is rounding.
/// Each iteration would square the error if forces did not rotate with the normals; they do, and the error changes by a
/// factor of their size times the curvature of the surface over the stiffness of the step: mostly small, one half in a
/// hard impact, and above one if a step is long for the force it requires. So iterations that do not settle by
/// themselves are accelerated.
class TangentIterations {
 public:
  explicit TangentIterations(const SemidiscreteProblem& problem, const ContactThresholds& thresholds = {});
  /// Starts from a stage that has been solved once. Throws Error(not_converged).
  void follow_motion(StageSolver& solver, Stage& stage, StageSolution& solution);

 private:
  void linearize_at(const Vector& increment, bool accelerate);

  const SemidiscreteProblem& problem_;
  ContactThresholds thresholds_;
  Vector gap_;
  AndersonAcceleration acceleration_{12};
  Vector linearized_at_;  ///< contact motion
  Vector point_, image_;  ///< of an iteration, on contact dofs
};

}  // namespace ricochet
