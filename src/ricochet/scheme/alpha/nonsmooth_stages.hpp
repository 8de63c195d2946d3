#pragma once

#include "ricochet/scheme/alpha/alpha_scheme.hpp"

/// @file The two contact problems of a step of the nonsmooth generalized-α scheme: positions, then velocities.
namespace ricochet {

/// Solves both problems of a step and holds their quantities, in the notation of nonsmooth_generalized_alpha.cpp.
/// Accelerations and support reactions "without contact" lack the contribution of contact. Vectors have one value per
/// dof, those of support reactions one per supported dof.
class NonsmoothStages {
 public:
  explicit NonsmoothStages(double restitution) : restitution_(restitution) {}

  /// Numbers of the stages with the operators αM + K and M.
  static constexpr std::size_t position_stage = 0, velocity_stage = 1;

  // solve_positions() reads these from the state at the start of the step; it replaces a₀ and the support reactions by
  // those at the end.
  Vector acceleration_without_contact;      ///< a₀, then a₁
  Vector support_reaction_without_contact;  ///< at the start, then at the end
  Vector algorithmic_start;                 ///< algorithmic acceleration A₀

  // solve_positions() computes these.
  Vector displacement_increment;  ///< ΔU = U₁ − U₀
  Vector position_jump;           ///< Q
  Vector algorithmic_end;         ///< algorithmic acceleration A₁
  Vector algorithmic_increment;   ///< ΔA = A₁ − A₀
  Vector mean_support_reaction;   ///< mean of the support reactions without contact, weighted as F̄

  // solve_velocities() computes these.
  Vector algorithmic_mean;    ///< A*
  Vector predicted_velocity;  ///< V₀ + hA*, the velocity without the jump W

  /// Excludes contact forces r that act at t = 0 from a₀, A₀ and the support reactions: M⁻¹Gᵀr is subtracted from the
  /// acceleration of the state.
  void start(const SemidiscreteProblem& problem, State& state, StageSolve& stages);
  /// Solves the problem of the positions.
  void solve_positions(const SemidiscreteProblem& problem, const State& state, double step, const AlphaWeights& weights,
                       StageSolve& stages);
  /// Solves the problem of the velocities, after that of the positions. The solution has W as its increment; its
  /// reactions are impulses, forces times time: Λ as normal_reaction, and those of the supports during the jump.
  const StageSolution& solve_velocities(const SemidiscreteProblem& problem, const State& state, double step,
                                        const AlphaWeights& weights, StageSolve& stages);

  StepEquations& equations() { return equations_; }

 private:
  const StageSolution& solve_jump(const SemidiscreteProblem& problem, const Vector& multiplier, StageSolve& stages);

  double restitution_;
  Vector shift_, base_;         ///< c/α of AlphaScheme; displacement at which the contact of a stage is evaluated
  Vector position_multiplier_;  ///< ν
  StepEquations equations_;
};

/// Key of State::memory: support reactions without contact at the end of the last step.
inline const std::string smooth_support_reaction = "smooth_support_reaction";
/// Key of State::memory: the varying load contained in a₀. A load set between two steps is not contained.
inline const std::string smooth_varying_load = "smooth_varying_load";

}  // namespace ricochet
