#pragma once

#include "ricochet/scheme/alpha/alpha_scheme.hpp"

/// @file The two contact problems of a step of the nonsmooth generalized-α scheme: positions, then velocities.
namespace ricochet {

class NonsmoothStages {
 public:
  explicit NonsmoothStages(double restitution) : restitution_(restitution) {}

  /// Numbers of the stages with the operators αM + K and M.
  static constexpr std::size_t position_stage = 0, velocity_stage = 1;

  // Of the start of the step.
  Vector smooth, algorithmic;  ///< accelerations a₀ and A₀ without contact; position() replaces a₀ by a₁
  Vector support;              ///< what supports exert without contact; likewise
  void take_start(const State& state);
  /// Takes contact forces out of an acceleration and support reactions: a − M⁻¹Gᵀr.
  void take_contact_off(const SemidiscreteProblem& problem, const StepForces& forces, Vector& acceleration,
                        Vector& support_reaction, StageSolve& stages);

  // Of the end.
  Vector motion;    ///< U₁ − U₀
  Vector jump;      ///< Q
  Vector after;     ///< A₁
  Vector velocity;  ///< V₀ + hA*
  Vector mean;      ///< A*
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

}  // namespace ricochet
