#pragma once

#include <functional>

#include "ricochet/linear_algebra/qr_anderson_acceleration.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/contact_newton.hpp"
#include "ricochet/step/factor_debt.hpp"
#include "ricochet/step/stage.hpp"

/// @file Stages whose internal force is nonlinear in the displacement.
namespace ricochet {

/// Solves αM δ + ηC δ + f(p + κδ) − f(p) = b + Hᵀρ with the contact conditions of the stage by Newton's method with a
/// factor that is kept (f without follower loads, which are in b at p): A d = residual + Hᵀρ, δ += d, with the contact
/// conditions for δ + d, linear about δ, in every iteration.
class StageNewton : private NewtonEquations {
 public:
  explicit StageNewton(const SemidiscreteProblem& problem) : problem_(problem) {}

  /// Solvers of the linear stage, and of a new factor at a displacement.
  using SolveLinear = std::function<void(const Stage&, StageSolution&)>;
  using Renew = std::function<void(const Vector& displacement)>;
  struct Task {
    OperatorCoefficients coefficients;
    double renewal_price;  ///< number of iterations that take as long as `renew`
    SolveLinear solve_linear;
    Renew renew;
    FactorDebt& debt;  ///< of this stage
  };
  /// Leaves the stage as in the last iteration. Throws Error(not_converged).
  void solve(const Task& task, Stage& stage, StageSolution& solution);

 private:
  Iteration iterate() override;
  void accelerate() override { acceleration_.advance(before_, total_, total_); }
  void forget_iterates() override { acceleration_.restart(); }
  void evaluate() override;
  void halve() override { total_ = 0.5 * (total_ + before_); }
  void renew() override { task_->renew(displacement_); }
  [[nodiscard]] bool freeze() override { return problem_.contact.freeze_pairs(); }
  void store_stage(const Stage& stage);
  void linearize();
  void find_force(const Vector& displacement, Vector& force);

  const SemidiscreteProblem& problem_;
  const Task* task_ = nullptr;
  Stage* stage_ = nullptr;
  StageSolution* solution_ = nullptr;
  int contact_iterations_ = 0;
  ContactNewton newton_;
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
