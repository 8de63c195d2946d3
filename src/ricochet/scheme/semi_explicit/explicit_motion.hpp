#pragma once

#include "ricochet/scheme/state.hpp"

/// @file Motion of the dofs with inertia in an explicit step, each by itself.
namespace ricochet {

class ExplicitMotion {
 public:
  /// Requires a diagonal mass and damping.
  void analyse(const SemidiscreteProblem& problem, double step);
  /// Diagonals of M and C on this rank; the latter empty without damping.
  [[nodiscard]] const Vector& mass() const { return mass_; }
  [[nodiscard]] const Vector& damping() const { return damping_; }

  /// Computes the increment hV^{n+½} of move(), also on contact dofs, and leaves the state unchanged.
  void predict(const SemidiscreteProblem& problem, double step, const State& state, Vector& increment) const;
  /// Computes U^{n+1} = Uⁿ + hV^{n+½}, and V^{n+½} = Vⁿ + (h/2)Aⁿ in place of the velocity; `correction` is added on
  /// contact dofs, and supported dofs move to their displacements in the state's memory. `increment` receives
  /// U^{n+1} − Uⁿ.
  void move(const SemidiscreteProblem& problem, const Vector& correction, double step, State& state, Vector& increment);
  /// Computes A^{n+1} from (M + (h/2)C) A = L − K U − C V^{n+½}, and V^{n+1} = V^{n+½} + (h/2)A^{n+1}; `force` is K U.
  void accelerate(const Vector& force, const Vector& load, double step, State& state);

 private:
  const Ranks* ranks_ = &one_rank();
  Vector mass_, damping_;
  Vector inverse_mass_;  ///< (M + (h/2)C)⁻¹ on unsupported dofs with mass, else 0
  Vector support_increment_, residual_;
};

}  // namespace ricochet
