#pragma once

#include "ricochet/problem/stage.hpp"
#include "ricochet/scheme/state.hpp"

/// @file How far points that stick have come from where they began to: a remainder of rounding, which the next step
/// takes back. The sum of all steps telescopes, so a point that sticks stays where it is, however many steps there are.
namespace ricochet {

class StickMemory {
 public:
  /// Shifts the slip rate of a stage (over a step h) by what points that stick have moved so far.
  void require(const SemidiscreteProblem& problem, const State& state, double step, Stage& stage);
  /// After a step, of which `before` was the displacement at its start.
  void learn(const SemidiscreteProblem& problem, const Vector& before, State& state);

 private:
  Vector motion_, slip_;
};

}  // namespace ricochet
