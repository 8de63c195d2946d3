#pragma once

#include <memory>

#include "ricochet/linear_algebra/anderson_acceleration.hpp"
#include "ricochet/problem/newton_progress.hpp"
#include "ricochet/scheme/stage_solve.hpp"

/// @file Contact nodes without inertia in an explicit step where the internal force f = ∂W/∂u is no linear function of
/// the displacement: with c the contact nodes and all others where the step has taken them,
///   f_c(u_f, u_c) = L_c + Gᵀ r_N − B_Tᵀ r_T,   0 ≤ r_N ⟂ g(u) ≥ 0,   friction on B_T (u − uⁿ)/h.
/// Newton's method with the factor of K_cc that the run has, which turns with the bodies (turned_frame.hpp) and is
/// renewed where corrections shrink too slowly: K_cc δ = L_c − f_c + Hᵀρ, u_c += δ, the contact conditions exact in
/// every round; after some rounds accelerated, since the factor is that of another strain. Forces are those of the
/// cells at contact nodes alone. It starts from the places that contact nodes reach with the velocity of the last step.
namespace ricochet {

class LayerEquilibrium {
 public:
  void analyse(const SemidiscreteProblem& problem);
  void start(State& state) const;
  /// Moves contact nodes: `end` is the displacement at the end of the step and `increment` that of the step, of all
  /// dofs. Returns null where there is no contact dof. Throws Error(not_converged).
  const StageSolution* solve(const SemidiscreteProblem& problem, const State& state, const Vector& load, double step,
                             StageSolve& stages, Vector& increment, Vector& end);

  /// After a step: makes the factor anew where that one took many iterations and the factor was not made a short time
  /// ago, so that the next steps take fewer. That takes the tangent of the whole body.
  void renew_where_slow(const SemidiscreteProblem& problem, State& state, StageSolve& stages);

 private:
  void require(const SemidiscreteProblem& problem, const State& state, const Vector& load, double step,
               const Vector& increment, const Vector& end, Stage& stage);
  void evaluate(const SemidiscreteProblem& problem, const State& state, Vector& increment, Vector& end);
  void move_to(const SemidiscreteProblem& problem, const State& state, const Vector& place, Vector& increment,
               Vector& end);

  std::shared_ptr<const InternalForce> layer_;  ///< of the cells at contact nodes
  double reach_ = 0.0;                          ///< of the nodes from the origin
  NewtonProgress progress_;
  AndersonAcceleration acceleration_{6};
  Vector force_, middle_, rate_;
  /// Per contact dof: increment of a round, with its correction, and the last change of it.
  Vector point_, image_, move_;
  bool moved_ = false;
};

}  // namespace ricochet
