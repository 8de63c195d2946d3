#pragma once

#include "ricochet/linear_algebra/qr_anderson_acceleration.hpp"
#include "ricochet/scheme/reduced/finite_strain_iterate.hpp"

/// @file Iterations of a step at finite strain with the factors of earlier positions.
namespace ricochet {

/// With δ the solution of the linear stage of the middle and m its motion of contact nodes: x += δ, u₁ += 2δ, on
/// contact nodes u₁ += K_cc⁻¹ (L₁ + P_c(u₁) − f_c(u₁) − 2b_c) + 2m. Contact conditions hold to rounding in every
/// iteration.
class KeptFactorEquations : public FiniteStrainEquations {
 public:
  using FiniteStrainEquations::FiniteStrainEquations;

  Iteration iterate() override;
  void accelerate() override;
  void forget_iterates() override { acceleration_.restart(); }
  void renew() override { iterate_.task().stages.renew_operators(iterate_.now().middle, iterate_.now().end); }
  [[nodiscard]] const StageSolution& solution() const override { return *solution_; }

 private:
  void require_contact(Stage& stage);
  void solve();
  void correct();
  void throw_if_inverted();

  const StageSolution* solution_ = nullptr;
  QrAndersonAcceleration acceleration_{NewtonThresholds().stored_iterations};
  Vector end_residual_, contact_right_hand_side_, linearization_motion_, next_end_;
  Vector point_, image_;  ///< of an accelerated iteration
  Vector scratch_;        ///< a force that is evaluated for its error alone
};

}  // namespace ricochet
