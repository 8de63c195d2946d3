#pragma once

#include "ricochet/scheme/state.hpp"
#include "ricochet/step/stage.hpp"

/// @file Drift of sticking points from their initial position: a remainder of rounding, which the next step reverses.
/// The sum over all steps telescopes, so a sticking point stays where it is, however many steps there are.
namespace ricochet {

class StickingDrift {
 public:
  /// Shifts the slip rate of a stage (over a step h) by the drift of sticking points so far.
  void require(const SemidiscreteProblem& problem, const State& state, double step, Stage& stage);
  /// Updates the drift after a step; `before` is the displacement at its start.
  void update_drift(const SemidiscreteProblem& problem, const Vector& before, State& state);

 private:
  Vector motion_, slip_;
};

}  // namespace ricochet
