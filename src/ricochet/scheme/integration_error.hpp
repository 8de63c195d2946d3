#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file What a mean of the internal forces of both ends of a step misses of the change of the elastic energy.
namespace ricochet {

/// ΔW − ΔU·[(1−w)f₀ + wf₁]: for linear elasticity −(w−½)ΔUᵀKΔU, else without a sign. Force and energy of the start are
/// those that were computed for the end of the step before; where that was another step they are computed anew.
class IntegrationError {
 public:
  /// At the start of a step.
  void begin(const SemidiscreteProblem& problem, const State& state);
  /// At its end, with the new displacement in the state but the number of the step before.
  [[nodiscard]] double end(const SemidiscreteProblem& problem, const Vector& increment, double weight,
                           const State& state);

 private:
  long step_ = -1;
  double energy_ = 0.0;
  Vector force_, mean_;
};

}  // namespace ricochet
