#pragma once

#include "ricochet/scheme/step_equations.hpp"

/// @file Contact conditions at the end of a step, for schemes whose contact nodes have no inertia.
namespace ricochet {

/// Drift of sticking points from their initial position: a remainder of rounding, which the next step reverses. The sum
/// over all steps telescopes, so a sticking point stays where it is, however many steps there are.
class StickingDrift {
 public:
  /// Shifts the slip rate of a stage (over a step h) by the drift of sticking points so far.
  void require(const SemidiscreteProblem& problem, const State& state, double step, Stage& stage);
  /// Updates the drift after a step; `before` is the displacement at its start.
  void update_drift(const SemidiscreteProblem& problem, const Vector& before, State& state);

 private:
  Vector motion_, slip_;
};

class EndContact {
 public:
  /// Imposes no penetration at `end_displacement` + 2m and friction on the slip of the step and, if a mean of
  /// the reactions acts, sets the start of its path. `end_displacement` is the displacement of contact nodes at
  /// the end, at δ = 0. `linear_about`: contact motion about which the conditions of gaps that are not linear are
  /// linear, and where the geometry is evaluated; null: 0.
  void require(const SemidiscreteProblem& problem, ActingReaction acting, double step, const State& state,
               const Vector& end_displacement, StepEquations& equations, Stage& stage,
               const Vector* linear_about = nullptr);
  /// Updates the memory of sticking points after the step. `before` is the displacement at its start.
  void update_drift(const SemidiscreteProblem& problem, const Vector& before, State& state) {
    stick_.update_drift(problem, before, state);
  }

 private:
  StickingDrift stick_;
  Vector rate_;
};

}  // namespace ricochet
