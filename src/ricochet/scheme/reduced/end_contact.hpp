#pragma once

#include "ricochet/scheme/reduced/stick_memory.hpp"
#include "ricochet/scheme/step_equations.hpp"

/// @file The contact conditions at the end of a step, of schemes whose contact nodes have no inertia.
namespace ricochet {

class EndContact {
 public:
  /// No penetration at `place` + 2m, friction on the slip of the step, and where a mean of the reactions acts what its
  /// path starts from. `place`: where contact nodes are at the end, at δ = 0.
  void require(const SemidiscreteProblem& problem, ReactionMean mean, double step, const State& state,
               const Vector& place, StepEquations& equations, Stage& stage);
  /// After the step. `before`: the displacement at its start.
  void learn(const SemidiscreteProblem& problem, const Vector& before, State& state) {
    stick_.learn(problem, before, state);
  }

 private:
  StickMemory stick_;
  Vector rate_;
};

}  // namespace ricochet
