#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file What the internal forces that a scheme takes for a step miss of the change of the elastic energy.
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

/// The same of the force half way, ΔW − ΔU·f(U₀+½ΔU): zero for linear elasticity, else of the order h³ and without a
/// sign. The energy of the start is that of the end of the step before; where that was another step it is computed
/// anew.
class MidpointIntegrationError {
 public:
  /// Of a step that goes on from the state, before the state is changed. Throws as InternalForce::energy() does where a
  /// cell is turned inside out at the end of the step, which half way need not show.
  [[nodiscard]] double of_step(const SemidiscreteProblem& problem, const State& state, const Vector& increment);

 private:
  long step_ = -1;
  double energy_ = 0.0;
  Vector place_, force_;
};

}  // namespace ricochet
