#pragma once

#include <memory>
#include <optional>

#include "ricochet/linear_algebra/anderson_acceleration.hpp"
#include "ricochet/problem/flight_prediction.hpp"
#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/scheme/reduced/end_contact.hpp"
#include "ricochet/scheme/reduced/energy_secant.hpp"
#include "ricochet/scheme/reduced/lagged_rows.hpp"
#include "ricochet/scheme/reduced/step_loads.hpp"
#include "ricochet/scheme/reduced/velocity_correction.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/newton_progress.hpp"

/// @file The step of massless_contact_step.hpp for an internal force f = ∂W/∂u that is nonlinear in the displacement.
///
/// With c the contact nodes, f the others, H, ρ and the mean ρ̄ as there, Δ = u₁ − u₀, x the middle of the step, which
/// is ½(u₀+u₁) on f and determined by the equations on c, and the forces at x of two stresses,
///   f̄ of S(E(x) + ⅛ (∇Δ)ᵀ∇Δ)  (InternalForce::mean_force),
///   p of 𝔻₀ : the derivative of E along Δ  (InternalForce::strain_force),   D = f̄ + σ p:
///   M (v₁−v₀)/h + (2/h) C (x−u₀) + D = L̄ on f,   D = L̄ + Hᵀρ̄ on c,   f(u₁) = L₁ + Hᵀρ on c,
/// and Coulomb's law at the end. D has neither resultant nor moment about x besides contact and loads, so linear and
/// angular momentum change by the impulses of these alone, for every σ. The scalar σ makes the work of D the change of
/// the elastic energy. A rigid motion has no stress: bodies that spin do not swell. Reactions of the end that act over
/// the whole step move contact nodes at its start, by J, to the minimum of W(u) − (L₀ + Hᵀρ)·u_c over u_c at u_f0.
/// The required works,
///   D_f·Δ_f = ΔW − L̄·Δ_c − ℓ − μ (ρ·HΔ_c − d),   ℓ = (L₁ − L₀)·(½(u₀+u₁) − x)_c,   ρ̄ = (1−μ) ρ̄_path + μ ρ,
///   d = [W(u₀) − (L₀+Hᵀρ)·u_c0] − min over u_c of the same ≥ 0,
/// are those of a body with a quadratic W at σ = 0, and yield
///   E₁ − E₀ = work of L̄, supports and damping + ℓ + μ (ρ·HΔ_c − d):
/// L̄·Δ_c + ℓ is the work of linearly changing loads on contact nodes whose positions over the step have the mean x
/// (for μ = 1, J first: ℓ = −½(L₁−L₀)·J). ρ·HΔ_c = −r_N·g₀ − Σ F r_N |Δy_T| ≤ 0 against planes.
/// A pressure P(u, t) that follows the surface is added as P(x), with the mean of the pressures at both ends, to L̄ in
/// the equations at x, so that over a closed surface it has neither resultant nor moment about x; as P(u₁) to L₁; and
/// as P₀ = 2P(x) − P(u₁) to L₀.
///
/// If no σ changes the work of D, velocities at the end balance the energy (velocity_correction.hpp).
///
/// With μ = 0 energy is conserved, with μ > 0 no step creates any: d ≥ 0 only means that J leads to a minimum, which
/// holds while K_cc is positive definite on the way. A step with d < 0 is refused.
///
/// Viscoelastic branches (fem/relaxation.hpp) add the forces of 2gμ q̄ to f̄ and those of 2gμ q₁ to f(u₁), both for the
/// strain that changes linearly from 2Ē − E₁ to E₁. If a mean of the reactions puts x_c half way, that is the step's
/// own strain; reactions of the end that act over the whole step move contact nodes, and with them this strain, at its
/// start by J. With V(u, A) = W(u) + Σ ∫ gμ |dev E(u) − A|², the stored energy, 𝒟 ≥ 0 of relaxation.hpp, and
///   P(u) = W(u) + Σ ∫ gμ (2(1−θ) |dev E(u) − A₀|² + 2(2θ−1) q₁ : E(u)) − (L₀ + Hᵀρ)·u_c,
/// the required works are those above with V(u₁, A₁) − V(u₀, A₀) + 𝒟 for ΔW, with d = P(u₀) − min over u_c of P ≥ 0, so
/// that
///   E₁ − E₀ = work of loads, supports and damping + ℓ + μ (ρ·HΔ_c − d) − 𝒟,   d ≥ 0,   𝒟 ≥ 0:
/// no step creates energy, for any h/τ. If V is quadratic in the displacement and the end reactions act, P has its
/// minimum at the displacement of E₀ + J, since its force there is 2D − f(u₁) = L₀ + Hᵀρ; D then does exactly the
/// required work, and σ = 0.
///
/// For W quadratic in the displacement, σ = 0 and this is massless_contact_step.hpp. (The mean of strains is that of J.
/// C. Simo and N. Tarnow, Z. Angew. Math. Phys. 43 (1992) 757–792; a scalar that makes a midpoint force conserve energy
/// is due to O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449–467.)
namespace ricochet {

/// Thresholds of the balance of energy; defects are relative to kinetic and elastic energy.
struct EnergyThresholds {
  double tolerance = 1e-15;         ///< admissible defect; for the choice of σ relative to the elastic energies
  double weak_tolerance = 1e-14;    ///< if σ hardly changes the work: another σ improves nothing but rounding there
  double near_rounding = 1e-12;     ///< below which rounding hides how a defect depends on σ
  double slow_convergence = 1e-13;  ///< above which iterations end after two that do not halve it, below after one
  double near_solution = 1e-2;  ///< correction relative to the increment, up to which displacements suffice to find σ
  double max_defect = 1e-8;     ///< of a full step that no σ balances; of a substep times its part of the full step,
  double min_part = 0.1;        ///< which counts as at least this
  double max_corrected = 1e-6;  ///< up to which velocities compensate a defect
  double max_snapped = 1e-4;    ///< likewise in a substep below short_part, where contact nodes snap to another
  double short_part = 1.0 / 64.0;  ///< equilibrium: shorter ones would have the same defect
  double max_created = 1e-11;      ///< energy that the end reactions may create
  int max_pair_iterations = 80;    ///< iterations after which pairs of facets that keep changing are frozen
};

class FiniteStrainStep {
 public:
  /// Analyses the problem, once its mass and supports are known, for steps of this full length. Throws
  /// Error(invalid_input).
  void analyse(const SemidiscreteProblem& problem, double step);
  [[nodiscard]] static std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem, double step,
                                                                   ActingReaction acting);
  void advance(const SemidiscreteProblem& problem, ActingReaction acting, double step, State& state, StageSolve& stages,
               Vector& increment);
  [[nodiscard]] const StepCorrections& corrections() const { return corrections_; }
  /// Middle x of the last step.
  [[nodiscard]] const Vector& middle() const { return middle_; }

 private:
  struct Iteration {
    double correction = 0.0;  ///< largest entry of the last correction
    double increment = 0.0;   ///< largest entry of the increment so far
  };
  struct Reactions {
    Vector normal, tangential, acting_normal, acting_tangential;
  };
  void start(const SemidiscreteProblem& problem, double step, const State& state);
  /// Evaluates forces at the middle and at the end; near the solution also the energy defect, and σ for it.
  void evaluate(const SemidiscreteProblem& problem, double step, const State& state, bool near);
  const StageSolution& solve_iteration(const SemidiscreteProblem& problem, ActingReaction acting, double step,
                                       const State& state, StageSolve& stages);
  [[nodiscard]] bool is_balanced(double step, const State& state, const Iteration& iteration, bool near);
  [[nodiscard]] bool correct_velocity(double step, const State& state);
  /// Admissible energy defect, relative to the energies.
  [[nodiscard]] double tolerance() const;
  /// Holds the present pairs of facets until the end of the step. Returns false if there are none, or if they are held
  /// already.
  [[nodiscard]] bool freeze_pairs(const SemidiscreteProblem& problem);
  /// Follows the advice on the progress of an iteration. Throws Error(not_converged).
  void apply_advice(const SemidiscreteProblem& problem, NewtonProgress::Advice advice, const Iteration& iteration,
                    StageSolve& stages);
  void balance(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage);
  void require_contact(const SemidiscreteProblem& problem, ActingReaction acting, double step, const State& state,
                       StageSolve& stages, Stage& stage);
  Iteration correct(const SemidiscreteProblem& problem, const State& state, const StageSolution& solution);
  void accelerate(const SemidiscreteProblem& problem, const State& state);
  [[nodiscard]] static double obstacle_work(Stage& stage, const Vector& normal, const Vector& tangential, double step);
  void update_start(const SemidiscreteProblem& problem, double step, const State& state, StageSolve& stages,
                    Stage& stage, const StageSolution& solution);
  void finish(const SemidiscreteProblem& problem, double step, State& state, Stage& stage,
              const StageSolution& solution, Vector& increment);
  void throw_if_inverted(const SemidiscreteProblem& problem);
  void evaluate_with_halving(const SemidiscreteProblem& problem, double step, const State& state, bool near);

  EnergyThresholds thresholds_;
  std::unique_ptr<FlightPrediction> flight_;
  std::shared_ptr<const InternalForce> contact_cells_;  ///< of the cells at contact nodes alone
  NewtonProgress progress_;
  EnergySecant sigma_;
  std::unique_ptr<VelocityCorrection> velocity_correction_;
  bool corrects_velocity_ = false, snap_logged_ = false;
  EndContact contact_;
  LaggedRows lagged_;    ///< for rows that follow the motion
  Reactions reactions_;  ///< of the previous iteration in this step, if any
  bool has_reactions_ = false;
  AndersonAcceleration acceleration_{8};
  StepEquations equations_;
  StepLoads loads_;
  StepCorrections corrections_;
  long energy_step_ = -1;                       ///< step whose end has been evaluated
  double last_energy_ = 0.0;                    ///< V there
  std::optional<double> contact_energy_start_;  ///< of the cells at contact nodes, on demand
  double viscous_dissipation_ = 0.0;            ///< 𝒟
  double energy_ = 0.0, energy_start_ = 0.0, energy_defect_ = 0.0, end_weight_ = 0.0, dissipation_ = 0.0;
  bool converged_ = false;                          ///< displacements
  double kinetic_start_ = 0.0, kinetic_ = 0.0;      ///< at the start; at the end, in the previous iteration
  double energy_defect_size_ = 0.0;                 ///< |energy_defect_| at the last test of the balance
  double whole_step_ = 0.0;                         ///< length of a full step
  double part_ = 1.0;                               ///< fraction of it that this step covers
  int stalled_iterations_ = 0;                      ///< iterations in a row that did not halve the energy defect
  double work_at_end_ = 0.0, obstacle_work_ = 0.0;  ///< ρ·HΔ_c less the obstacles' motion; work of ρ̄ on that motion
  double load_work_ = 0.0;                          ///< of changing loads, besides that of their mean on the increment
  Vector base_, middle_, end_, increment_, force_, strain_force_, end_force_, end_contact_force_, mean_contact_force_;
  Vector at_start_;                            ///< L₀ + P₀ + Hᵀρ
  Vector internal_;                            ///< A₁
  Vector jumped_displacement_;                 ///< u₀ + J
  Vector inertial_increment_;                  ///< x − (u₀ + ½h v₀), so that v₁ − v₀ = (4/h)(x − base)
  Vector inertial_force_;                      ///< M times that
  Vector half_increment_;                      ///< x − u₀
  Vector mean_external_force_;                 ///< L̄ + Hᵀρ̄
  Vector linearization_motion_;                ///< contact motion about which conditions are linear
  Vector contact_residual_;                    ///< L₁ + P_c(u₁) − f_c(u₁) − 2 b_c
  Vector jump_, jump_force_, start_residual_;  ///< J; f(u₀ + J); L₀ + P₀ + Hᵀρ − f(u₀ + J)
  Vector end_velocity_, next_end_, contact_right_hand_side_, damping_force_, before_, last_middle_, last_end_;
  Vector scratch_;           ///< a force that is evaluated for its error alone
  Vector point_, image_;     ///< of an accelerated iteration
  Vector lagged_row_force_;  ///< of the reactions, along rows less the lagged ones
};

}  // namespace ricochet
