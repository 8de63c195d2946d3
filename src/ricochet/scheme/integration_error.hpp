#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Integration error of the elastic energy: its change less the work of the internal forces that a scheme uses
/// for a step.
namespace ricochet {

/// Error ΔW − ΔU·[(1−w)f₀ + wf₁]: for linear elasticity −(w−½)ΔUᵀKΔU, otherwise without a sign. Force and energy at the
/// start are those computed for the end of the previous step; they are evaluated anew if that was another step.
class IntegrationError {
 public:
  /// Starts a step.
  void begin(const SemidiscreteProblem& problem, const State& state);
  /// Returns the error at the end of the step. The state has the new displacement, but the number of the previous step.
  [[nodiscard]] double end(const SemidiscreteProblem& problem, const Vector& increment, double weight,
                           const State& state);

 private:
  long step_ = -1;
  double energy_ = 0.0;
  Vector force_, mean_;
};

/// Error ΔW − ΔU·f(U₀+½ΔU) of the force at the middle: zero for linear elasticity, otherwise of order h³ and without a
/// sign. The energy at the start is that of the end of the previous step; it is evaluated anew if that was another
/// step.
class MidpointIntegrationError {
 public:
  /// Returns the error of a step from `state`, before the state is changed. Throws as InternalForce::energy() does if a
  /// cell is inverted at the end of the step, which need not show half way.
  [[nodiscard]] double of_step(const SemidiscreteProblem& problem, const State& state, const Vector& increment);

 private:
  long step_ = -1;
  double energy_ = 0.0;
  Vector displacement_, force_;
};

}  // namespace ricochet
