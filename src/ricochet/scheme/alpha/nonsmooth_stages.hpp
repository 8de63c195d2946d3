#pragma once

#include "ricochet/scheme/alpha/alpha_scheme.hpp"

/// @file The two contact problems of a step of the nonsmooth generalized-α scheme: positions, then velocities.
namespace ricochet {

class NonsmoothStages {
 public:
  explicit NonsmoothStages(double restitution) : restitution_(restitution) {}

  /// Numbers of the stages with the operators αM + K and M.
  static constexpr std::size_t position_stage = 0, velocity_stage = 1;

  /// At t = 0: contact that presses already is no part of a₀, A₀ and the support reactions, a₀ = a − M⁻¹Gᵀr.
  void start(const SemidiscreteProblem& problem, State& state, StageSolve& stages);

  // Of the start of the step, from the state.
  Vector smooth, algorithmic;  ///< accelerations a₀ and A₀ without contact; position() replaces a₀ by a₁
  Vector support;              ///< what supports exert without contact; likewise

  // Of the end.
  Vector motion;        ///< U₁ − U₀
  Vector jump;          ///< Q
  Vector after;         ///< A₁
  Vector change;        ///< A₁ − A₀
  Vector mean_support;  ///< (1−α_f) of what supports exert without contact, α_f of that at the start
  Vector velocity;      ///< V₀ + hA*
  Vector mean;          ///< A*
  /// U₁ and what comes with it.
  void position(const SemidiscreteProblem& problem, const State& state, double step, const AlphaWeights& weights,
                StageSolve& stages);
  /// Λ, and W as the solution's increment.
  const StageSolution& impulses(const SemidiscreteProblem& problem, const State& state, double step,
                                const AlphaWeights& weights, StageSolve& stages);

  StepEquations& equations() { return equations_; }

 private:
  const StageSolution& push(const SemidiscreteProblem& problem, const Vector& normal, StageSolve& stages);

  double restitution_;
  Vector shift_, base_, normal_;
  StepEquations equations_;
};

/// Key of State::memory: `support` of the last step.
inline const std::string smooth_support_reaction = "smooth_support_reaction";
/// Key of State::memory: the varying load that a₀ is of. A load that is set between two steps is not.
inline const std::string smooth_varying_load = "smooth_varying_load";

}  // namespace ricochet
