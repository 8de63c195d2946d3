#pragma once

#include "ricochet/scheme/reduced/finite_strain_exact.hpp"
#include "ricochet/scheme/reduced/finite_strain_kept_factor.hpp"

/// @file The step of massless_contact_step.hpp for an internal force f = ∂W/∂u that is nonlinear in the displacement.
///
/// With c the contact nodes, f the others, H, ρ and the mean ρ̄ as there, Δ = u₁ − u₀, and x the middle of the step,
/// which is ½(u₀+u₁) on f and determined by the equations on c, let u⁺ = 2x − u₁: u₀ on f, and on c the position after
/// a jump J at the start of the step. Over the step the strain goes along a straight path from E(u⁺) to E(u₁), and
///   D = ∫ F_x S̄ : ∇φ,   S̄ the mean of the stress along this path (fem/strain_path.hpp),
///   M (v₁−v₀)/h + (2/h) C (x−u₀) + D = L̄ on f,   D = L̄ + Hᵀρ̄ on c,   f(u₁) = L₁ + Hᵀρ on c,
/// and Coulomb's law at the end. Every S̄ is symmetric, so D has neither resultant nor moment about x, and linear and
/// angular momentum change by the impulses of contact, loads, supports and mass damping alone. A rigid motion has no
/// stress: bodies that spin do not swell. D does the work W(u₁) − W(u⁺) on u₁ − u⁺, and therefore
///   E₁ − E₀ = work of L̄, supports and damping + ℓ + μ ρ·HΔ − d',   ℓ = (L₁ − L₀)·(½(u₀+u₁) − x)_c,
///   d' = [W(u₀) − (L₀+Hᵀρ̄)·u_c0] − [W(u⁺) − (L₀+Hᵀρ̄)·u_c⁺] + μ ρ·HΔ − ρ̄·HΔ,   ρ̄ = (1−μ) ρ̄_path + μ ρ.
/// L̄·Δ_c + ℓ is the work of linearly changing loads on contact nodes whose positions over the step have the mean x.
/// ρ·HΔ_c = −r_N·g₀ − Σ F r_N |Δy_T| ≤ 0 against planes. If W is quadratic, u⁺ is for μ = 1 the minimum over u_c of
/// W(u) − (L₀+Hᵀρ)·u_c at u_f0, so that d' ≥ 0 is the energy that the jump loses, and for μ = 0 d' = 0; this is then
/// massless_contact_step.hpp. Else d' differs by terms of the third order in J and ΔE.
///
/// Iterations end when the increment is accurate enough (StageSolve::newton_tolerance). Velocities at the end then
/// compensate for the residual R of the forces, for the moments about x of contact forces between bodies, whose rows
/// belong to the mean of both ends, and for all other errors of the balance (step_balance.hpp): momenta change by
/// impulses, and energy by the terms above, to rounding, with any tolerance. Contact conditions hold to rounding in
/// every iteration. d' counts as numerical dissipation as far as the step really loses it, and d' < 0 counts as zero.
///
/// A pressure P(u, t) that follows the surface is added as P(x), with the mean of the pressures at both ends, to L̄ in
/// the equations at x, so that over a closed surface it has neither resultant nor moment about x; as P(u₁) to L₁; and
/// as P₀ = 2P(x) − P(u₁) to L₀.
///
/// Viscoelastic branches (fem/relaxation.hpp) add the forces of 2gμ q̄ to D and those of 2gμ q₁ to f(u₁), both for the
/// strain that changes linearly from E(u⁺) to E(u₁). With V(u, A) = W(u) + Σ ∫ gμ |dev E(u) − A|², the stored energy,
/// 𝒟 ≥ 0 of relaxation.hpp, and
///   P(u) = W(u) + Σ ∫ gμ (2(1−θ) |dev E(u) − A₀|² + 2(2θ−1) q₁ : E(u)),
/// the above holds with V(u₁, A₁) + 𝒟 for W at the end, V(u₀, A₀) for W at the start, and P for W in d'. If V is
/// quadratic and the end reactions act, P − (L₀+Hᵀρ)·u_c has its minimum at u⁺, as its force there is 2D − f(u₁) = L₀ +
/// Hᵀρ.
///
/// (The mean of strains is that of J. C. Simo and N. Tarnow, Z. Angew. Math. Phys. 43 (1992) 757–792; the work of the
/// mean stress along a path is that of R. I. McLachlan, G. R. W. Quispel and N. Robidoux, Philos. Trans. R. Soc. A 357
/// (1999) 1021–1045.)
namespace ricochet {

/// Steps are taken by iterations with the factors of earlier positions (KeptFactorEquations) or, where these do not
/// converge soon, with the exact tangent (ExactTangentEquations).
class FiniteStrainStep {
 public:
  /// Analyses the problem, once its mass and supports are known, for steps of this full length. Throws
  /// Error(invalid_input).
  void analyse(const SemidiscreteProblem& problem, double step);
  [[nodiscard]] static std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem, double step,
                                                                   ActingReaction acting);
  /// Takes a step. Throws Error(not_converged).
  void advance(const StepTask& task, Vector& increment);
  [[nodiscard]] const StepCorrections& corrections() const { return iterate_.corrections(); }
  /// Middle x of the last step.
  [[nodiscard]] const Vector& middle() const { return iterate_.now().middle; }

 private:
  class Wait;
  enum class NewtonStart {
    flight,
    start_of_step,
    descent  ///< from the start of the step, with proximal weights
  };
  void advance_with_kept_factor(const StepTask& task, Persistence persistence, Vector& increment);
  void advance_exactly_from(NewtonStart from, const StepTask& task, Vector& increment);
  [[nodiscard]] bool advance_exactly(const StepTask& task, Vector& increment);

  FiniteStrainIterate iterate_;
  KeptFactorEquations kept_{iterate_};
  ExactTangentEquations exact_{iterate_};
  ContactNewton newton_;
  /// None of the exact iterations asks for a new factor: all have their own. Their corrections may grow for a while.
  ContactNewton exact_newton_{NewtonThresholds{.max_iterations = 30, .max_renewals = 0, .early_divergence = 1e3}};
};

}  // namespace ricochet
