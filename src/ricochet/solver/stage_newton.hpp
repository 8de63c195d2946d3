#pragma once

#include <functional>

#include "ricochet/linear_algebra/qr_anderson_acceleration.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/newton_progress.hpp"
#include "ricochet/step/stage.hpp"

/// @file Stages whose internal force is nonlinear in the displacement.
namespace ricochet {

/// Solves αM δ + ηC δ + f(p + κδ) − f(p) = b + Hᵀρ with the contact conditions of the stage by Newton's method with a
/// factor that is kept (f without follower loads, which are in b at p): A d = residual + Hᵀρ, δ += d, with exact
/// contact conditions for δ + d in every iteration.
class StageNewton {
 public:
  explicit StageNewton(const SemidiscreteProblem& problem) : problem_(problem) {}

  /// Solvers of the linear stage, and of a new factor at a displacement.
  using SolveLinear = std::function<void(Stage&, StageSolution&)>;
  using Renew = std::function<void(const Vector& displacement)>;
  /// `renewal_price`: number of iterations that take as long as `renew`. Leaves the stage as in the last iteration.
  /// Throws Error(not_converged).
  void solve(const OperatorCoefficients& coefficients, double renewal_price, const SolveLinear& solve_linear,
             const Renew& renew, Stage& stage, StageSolution& solution);

 private:
  void store_stage(const Stage& stage);
  void linearize(const OperatorCoefficients& coefficients, Stage& stage);
  void correct(const Vector& correction);
  void update_internal_force(double factor);
  [[nodiscard]] bool has_frozen_rows() const {
    return problem_.contact.follows_motion() && problem_.contact.geometry->is_frozen();
  }
  /// Evaluates f less the follower loads.
  void evaluate(const Vector& displacement, Vector& force);

  const SemidiscreteProblem& problem_;
  NewtonProgress progress_;
  QrAndersonAcceleration acceleration_{NewtonThresholds().stored_iterations};
  Vector total_, before_, displacement_, force_, inertial_force_, damping_force_, zero_motion_, follower_load_;
  // Data of the stage at δ = 0:
  ForceLinearization linearization_;
  RightHandSide right_hand_side_;
  ContactConditions conditions_;
  std::optional<ContactMotion> motion_;
  Vector force_at_base_;
};

}  // namespace ricochet
