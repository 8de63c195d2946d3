#pragma once

#include "ricochet/scheme/integration_error.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"

namespace ricochet {

/// Scheme of C. Kane, E. A. Repetto, M. Ortiz and J. E. Marsden (Comput. Methods Appl. Mech. Engrg. 180 (1999) 1–26)
/// with β = ¼, γ = ½: the trapezoidal rule inside the body, contact and friction forces wholly those of the end of the
/// step,
///   M (V₁−V₀)/h + C (U₁−U₀)/h + K (U₀+U₁)/2 = L_½ + Gᵀ r_N − B_Tᵀ r_T,   (V₀+V₁)/2 = (U₁−U₀)/h,
///   0 ≤ r_N ⟂ g(U₁) ≥ 0,   friction on the slip rate B_T (U₁−U₀)/h.
/// Unknown x = U₁, base U₀ + hV₀, so that M (V₁−V₀)/h = (2/h²) M δ. In a step J changes by −r_N·g₀ − h r_T·w ≤ 0
/// besides the works of loads, supports and damping: no step creates energy, and every impact dissipates some. At
/// finite strain the internal force is f((U₀+U₁)/2), and its integration error, of either sign, is in
/// integration_error.hpp. (For β ≠ γ/2 the velocity requires a solve with M, and the change of J has a part without a
/// sign.)
class Kane : public Scheme {
 public:
  explicit Kane(double step)
      : Kane(step, "kane",
             {.acting_instant = -0.5,
              .supports_step_changes = true,
              .supports_nonlinear_force = true,
              .conserves_moments_at_finite_strain = true,
              .jump_response = JumpResponse::undamped}) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override {
    const double h = step();
    return {{2.0 / (h * h), 0.5, 1.0 / h}};
  }
  void analyse(const SemidiscreteProblem& problem) override;
  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override;
  [[nodiscard]] LastStep last_step() const override {
    return {.corrections = {.integration_error = integration_error_}};
  }

 protected:
  /// Creates a scheme derived from this one, for linear internal forces and bodies on one rank.
  Kane(double step, std::string name, double force_instant)
      : Kane(step, std::move(name),
             {.force_instant = force_instant,
              .acting_instant = -0.5,
              .supports_step_changes = true,
              .supports_ranks = false,
              .conserves_moments_at_finite_strain = true,
              .jump_response = JumpResponse::undamped}) {}
  /// Fills the stage except its contact conditions.
  Stage& balance(const SemidiscreteProblem& problem, const State& state, StageSolve& stages);
  /// Adds the contact conditions.
  void require_contact(const SemidiscreteProblem& problem, const State& state, Stage& stage);
  /// Advances the state to the end of the step.
  void advance_state(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution,
                     State& state, Vector& increment);
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Vector& base() const { return base_; }
  [[nodiscard]] StepEquations& equations() { return equations_; }

 private:
  Kane(double step, std::string name, const SchemeTraits& traits) : Scheme(step, traits), name_(std::move(name)) {}

  std::string name_;
  double integration_error_ = 0.0;
  Vector predicted_, base_, middle_;
  StepEquations equations_;
  MidpointIntegrationError error_;
};

}  // namespace ricochet
