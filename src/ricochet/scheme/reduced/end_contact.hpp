#pragma once

#include "ricochet/scheme/reduced/sticking_drift.hpp"
#include "ricochet/scheme/step_equations.hpp"

/// @file Contact conditions at the end of a step, for schemes whose contact nodes have no inertia.
namespace ricochet {

class EndContact {
 public:
  /// Imposes no penetration at `end_displacement` + 2m and friction on the slip of the step and, if a mean of
  /// the reactions acts, sets the start of its path. `end_displacement` is the displacement of contact nodes at
  /// the end, at δ = 0.
  void require(const SemidiscreteProblem& problem, ReactionMean mean, double step, const State& state,
               const Vector& end_displacement, StepEquations& equations, Stage& stage);
  /// Updates the memory of sticking points after the step. `before` is the displacement at its start.
  void update_drift(const SemidiscreteProblem& problem, const Vector& before, State& state) {
    stick_.update_drift(problem, before, state);
  }

 private:
  StickingDrift stick_;
  Vector rate_;
};

}  // namespace ricochet
