#pragma once

#include "ricochet/scheme/alpha/alpha_scheme.hpp"

/// @file The two contact problems of a step of the nonsmooth generalized-α scheme: positions, then velocities.
namespace ricochet {

class NonsmoothStages {
 public:
  explicit NonsmoothStages(double restitution) : restitution_(restitution) {}

  /// Numbers of the stages with the operators αM + K and M.
  static constexpr std::size_t position_stage = 0, velocity_stage = 1;

  /// Removes, at t = 0, contact that presses already from a₀, A₀ and the support reactions: a₀ = a − M⁻¹Gᵀr.
  void start(const SemidiscreteProblem& problem, State& state, StageSolve& stages);

  // At the start of the step, from the state:
  Vector smooth, algorithmic;  ///< accelerations a₀ and A₀ without contact; position() replaces a₀ by a₁
  Vector support;              ///< support reactions without contact; likewise

  // At the end:
  Vector motion;        ///< U₁ − U₀
  Vector jump;          ///< Q
  Vector after;         ///< A₁
  Vector change;        ///< A₁ − A₀
  Vector mean_support;  ///< (1−α_f) of the support reactions without contact, and α_f of those at the start
  Vector velocity;      ///< V₀ + hA*
  Vector mean;          ///< A*
  /// Computes U₁ and the values above that belong to it.
  void position(const SemidiscreteProblem& problem, const State& state, double step, const AlphaWeights& weights,
                StageSolve& stages);
  /// Computes Λ, and W as the solution's increment.
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
/// Key of State::memory: the varying load contained in a₀. A load set between two steps is not contained.
inline const std::string smooth_varying_load = "smooth_varying_load";

}  // namespace ricochet
