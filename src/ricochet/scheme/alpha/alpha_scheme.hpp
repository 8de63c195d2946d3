#pragma once

#include <string>

#include "ricochet/scheme/integration_error.hpp"
#include "ricochet/scheme/newmark_keys.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"

/// @file Alpha schemes: Newmark's scheme with inertia and forces weighted over the step.
namespace ricochet {

/// Parameters that follow from the weights α_m of inertia and α_f of forces at the start of a step.
struct AlphaWeights {
  AlphaWeights(double step, double of_inertia, double of_forces);

  double inertia_weight, force_weight;  ///< α_m and α_f
  double gamma, beta;                   ///< ½ + α_f − α_m and ¼(½+γ)²
  double alpha;                         ///< (1−α_m)/((1−α_f)βh²)
  double energy_factor;                 ///< ½h²(β−γ/2)
};
/// Weights of generalized-alpha for its spectral radius.
[[nodiscard]] AlphaWeights generalized_alpha_weights(double step, double spectral_radius);

/// Newmark's scheme with contact at the end of the step, whose forces are weighted as all others:
///   M [(1−α_m)A₁ + α_m A₀] = (1−α_f) F₁ + α_f F₀,   F = L − C V − K U + Gᵀ r_N − B_Tᵀ r_T,   0 ≤ r_N ⟂ g(U₁) ≥ 0,
///   friction on the slip rate B_T (U₁−U₀)/h,   U₁, V₁ from A₀, A₁ by Newmark's formulas with
///   γ = ½ + α_f − α_m,   β = ¼(½+γ)²   (J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371–375).
/// Written with the true acceleration a, M a = F at every t_n (M. Arnold, O. Brüls, Multibody Syst. Dyn. 18 (2007)
/// 185–202): (1−α_m)A₁ + α_m A₀ = (1−α_f)a₁ + α_f a₀. Unknown x = U₁, base Ũ − c/α with Ũ = U₀ + hV₀ + h²(½−β)A₀,
/// α = (1−α_m)/((1−α_f)βh²) and c = (α_m A₀ − α_f a₀)/(1−α_f), so that a₁ = α δ. The state's acceleration is a; A is in
/// its memory.
///
/// Energy: in a step J + ½h²(β−γ/2)AᵀMA changes by ΔUᵀ[α_f F₀+(1−α_f)F₁], with F the forces outside J, less
///   (½−α_f)(ΔUᵀKΔU + ΔUᵀMΔA) + ½h²(β−γ/2)(2γ−1)ΔAᵀMΔA,
/// which has no sign; the momentum M (V + (½−α_f)h A) changes by the impulses of the same forces. On massless dofs
/// a = A = 0, V = ΔU/h, and damping acts on ΔU/h, as under newmark.
class AlphaScheme final : public Scheme {
 public:
  AlphaScheme(double step, const AlphaWeights& weights)
      : Scheme(step, {.work_rule = {weights.force_weight, 1.0 - weights.force_weight},
                      .supports_step_changes = true,
                      .supports_nonlinear_force = true,
                      .suits_singular_mass = true,
                      .jump_response = newmark_jump_response({weights.beta, weights.gamma})}),
        weights_(weights) {}

  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem) const override {
    return {{weights_.alpha, 1.0, damping_factor(problem)}};
  }
  void start(const SemidiscreteProblem& problem, State& state, StageSolve& stages) override;
  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override;
  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override;
  bool momentum_acceleration(const State& state, Vector& acceleration) const override;
  [[nodiscard]] LastStep last_step() const override {
    return {.corrections = {.numerical_dissipation = dissipation_, .integration_error = integration_error_}};
  }

 protected:
  void step_changed(const SemidiscreteProblem&) override {
    weights_ = AlphaWeights(step(), weights_.inertia_weight, weights_.force_weight);
  }

 private:
  [[nodiscard]] double damping_factor(const SemidiscreteProblem& problem) const {
    return problem.has_singular_mass() ? 1.0 / step() : weights_.gamma / (weights_.beta * step());
  }
  void compute_damping_velocity(const SemidiscreteProblem& problem, const State& state, const Vector& before);
  void compute_dissipation(const SemidiscreteProblem& problem, const Vector& increment);

  AlphaWeights weights_;
  double dissipation_ = 0.0, integration_error_ = 0.0;
  Vector shift_, predicted_, base_, velocity_, change_, force_;
  StepEquations equations_;
  IntegrationError error_;
};

/// Key of State::memory: A, which differs from the acceleration of the forces.
inline const std::string algorithmic_acceleration = "algorithmic_acceleration";

/// Key "spectral_radius", for vibrations that are fast compared with the step; `least` is the smallest admissible
/// value.
[[nodiscard]] Key spectral_radius_key(double least);

}  // namespace ricochet
