#pragma once

#include <memory>

#include "ricochet/linear_algebra/qr_anderson_acceleration.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/step/contact_newton.hpp"
#include "ricochet/step/stage_solve.hpp"

/// @file Contact nodes without inertia in an explicit step for an internal force f = ∂W/∂u that is nonlinear in the
/// displacement: with c the contact nodes, and all others at their displacements at the end of the step,
///   f_c(u_f, u_c) = L_c + Gᵀ r_N − B_Tᵀ r_T,   0 ≤ r_N ⟂ g(u) ≥ 0,   friction on B_T (u − uⁿ)/h.
/// Newton's method with the run's factor of K_cc, which is kept in the corotated frame of the bodies
/// (corotated_frame.hpp) and renewed if corrections shrink too slowly: K_cc δ = L_c − f_c + Hᵀρ, u_c += δ, with exact
/// contact conditions in every iteration; accelerated after some iterations, since the factor is that of another
/// strain. Forces are those of the cells at contact nodes alone. Iterations start from the displacements that contact
/// nodes reach with the velocity of the last step.
namespace ricochet {

class NonlinearContactEquilibrium : private NewtonEquations {
 public:
  void analyse(const SemidiscreteProblem& problem);
  void start(State& state) const;
  /// Moves contact nodes: `end` is the displacement at the end of the step and `increment` that of the step, on all
  /// dofs. Returns null without contact dofs. Throws Error(not_converged).
  const StageSolution* solve(const SemidiscreteProblem& problem, const State& state, const Vector& load, double step,
                             StageSolve& stages, Vector& increment, Vector& end);

  /// Renews the factor after a step that took many iterations, unless it is recent, so that the next steps take fewer.
  /// Assembles the tangent of the whole body.
  void renew_where_slow(const SemidiscreteProblem& problem, State& state, StageSolve& stages);

 private:
  struct Task {
    const SemidiscreteProblem& problem;
    const State& state;
    const Vector& load;
    double step;
    StageSolve& stages;
    Vector &increment, &end;
  };
  Iteration iterate() override;
  void accelerate() override { acceleration_.advance(last_point_, point_, point_); }
  void forget_iterates() override { acceleration_.restart(); }
  void evaluate() override;
  void halve() override { point_ = 0.5 * (point_ + last_point_); }
  void renew() override { task_->stages.renew_operators(task_->end, task_->end); }
  void require(Stage& stage);
  void move_to_point();

  std::shared_ptr<const InternalForce> contact_cells_;  ///< of the cells at contact nodes
  double reach_ = 0.0;                                  ///< largest coordinate of the nodes
  ContactNewton newton_{NewtonThresholds{.plain_iterations = 2, .stored_iterations = 6}};
  QrAndersonAcceleration acceleration_{6};
  const Task* task_ = nullptr;
  const StageSolution* solution_ = nullptr;
  double last_correction_ = 0.0;
  Vector force_, middle_, rate_;
  Vector point_, last_point_;  ///< increments of contact dofs, after and before a correction
};

}  // namespace ricochet
