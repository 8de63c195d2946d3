#pragma once

#include <memory>
#include <optional>

#include "ricochet/linear_algebra/anderson_acceleration.hpp"
#include "ricochet/problem/flight_prediction.hpp"
#include "ricochet/problem/newton_progress.hpp"
#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/scheme/reduced/end_contact.hpp"
#include "ricochet/scheme/reduced/energy_secant.hpp"
#include "ricochet/scheme/reduced/lagged_rows.hpp"
#include "ricochet/scheme/reduced/step_loads.hpp"
#include "ricochet/scheme/reduced/velocity_correction.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"

/// @file The step of massless_layer.hpp where the internal force f = ∂W/∂u is no linear function of the displacement.
///
/// With c the contact nodes, f the others, H, ρ and the mean ρ̄ as there, Δ = u₁ − u₀, x the middle of the step,
/// ½(u₀+u₁) on f and on c where the equations on them have it, and the forces at x of two stresses,
///   f̄ of S(E(x) + ⅛ (∇Δ)ᵀ∇Δ)  (InternalForce::mean_force),
///   p of 𝔻₀ : the derivative of E along Δ  (InternalForce::strain_force),   D = f̄ + σ p:
///   M (v₁−v₀)/h + (2/h) C (x−u₀) + D = L̄ on f,   D = L̄ + Hᵀρ̄ on c,   f(u₁) = L₁ + Hᵀρ on c,
/// and Coulomb's law at the end. D has neither resultant nor moment about x beside contact and loads, so linear and
/// angular momentum change by the impulses of these alone, whatever σ is. The number σ makes the work of D the change
/// of the elastic energy. A rigid motion has no stress: bodies that spin do not swell. Reactions of the end that act
/// over all of a step move contact nodes at its start, by J, to where W(u) − (L₀ + Hᵀρ)·u_c is least over u_c at u_f0.
/// The works asked for,
///   D_f·Δ_f = ΔW − L̄·Δ_c − ℓ − μ (ρ·HΔ_c − d),   ℓ = (L₁ − L₀)·(½(u₀+u₁) − x)_c,   ρ̄ = (1−μ) ρ̄_path + μ ρ,
///   d = [W(u₀) − (L₀+Hᵀρ)·u_c0] − min over u_c of the same ≥ 0,
/// are those of a body with a quadratic W at σ = 0, and make
///   E₁ − E₀ = work of L̄, supports and damping + ℓ + μ (ρ·HΔ_c − d):
/// L̄·Δ_c + ℓ is the work of loads that change linearly on contact nodes whose places over the step have the mean x (for
/// μ = 1, J first: ℓ = −½(L₁−L₀)·J). ρ·HΔ_c = −r_N·g₀ − Σ F r_N |Δy_T| ≤ 0 against planes.
/// Where a pressure P(u, t) follows the surface, P(x), of the mean of the pressures at both ends, is added to L̄ in the
/// equations at x, so that all round a body it has neither resultant nor moment about x, P(u₁) to L₁, and
/// P₀ = 2P(x) − P(u₁) to L₀.
///
/// Where no σ changes the work of D, velocities at the end balance the energy (velocity_correction.hpp).
///
/// With μ = 0 energy is kept, with μ > 0 no step creates any: d ≥ 0 says no more than that J leads to a minimum, which
/// is so while K_cc is positive definite on the way. A step with d < 0 is refused.
///
/// Branches beside the laws (fem/relaxation.hpp) add the forces of 2gμ q̄ to f̄ and those of 2gμ q₁ to f(u₁), both for
/// the strain that goes linearly from 2Ē − E₁ to E₁. Where a mean of the reactions makes x_c half of the way, that is
/// the step's own strain; reactions of the end that act over all of it move contact nodes at its start, by J, and so
/// does this strain. With V(u, A) = W(u) + Σ ∫ gμ |dev E(u) − A|², the stored energy, 𝒟 ≥ 0 of relaxation.hpp, and
///   P(u) = W(u) + Σ ∫ gμ (2(1−θ) |dev E(u) − A₀|² + 2(2θ−1) q₁ : E(u)) − (L₀ + Hᵀρ)·u_c,
/// the works asked for are those above with V(u₁, A₁) − V(u₀, A₀) + 𝒟 for ΔW, with d = P(u₀) − min over u_c of P ≥ 0,
/// so that
///   E₁ − E₀ = work of loads, supports and damping + ℓ + μ (ρ·HΔ_c − d) − 𝒟,   d ≥ 0,   𝒟 ≥ 0:
/// no step creates energy, whatever h/τ is. Where V is quadratic in the displacement and the end reactions act, P is
/// least at the displacement of E₀ + J, since its force there is 2D − f(u₁) = L₀ + Hᵀρ; then D works just that, and
/// σ = 0.
///
/// Where W is quadratic in the displacement, σ = 0 and this is
/// massless_layer.hpp. (The mean of strains is that of J. C. Simo and N. Tarnow, Z. Angew. Math. Phys. 43 (1992)
/// 757–792; a number that makes a force of the middle keep energy that of O. Gonzalez, J. Nonlinear Sci. 6 (1996)
/// 449–467.)
namespace ricochet {

class FiniteLayer {
 public:
  /// After a mass and supports are known, with the whole step. Throws Error(invalid_input).
  void analyse(const SemidiscreteProblem& problem, double step);
  [[nodiscard]] static std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem, double step,
                                                                   ReactionMean mean);
  void advance(const SemidiscreteProblem& problem, ReactionMean mean, double step, State& state, StageSolve& stages,
               Vector& increment);
  [[nodiscard]] const StepCorrections& corrections() const { return corrections_; }
  /// x of the last step.
  [[nodiscard]] const Vector& middle() const { return middle_; }

 private:
  struct Round {
    double correction = 0.0;  ///< the largest entry of the last one
    double increment = 0.0;   ///< of the step so far
  };
  struct Reactions {
    Vector normal, tangential, acting_normal, acting_tangential;
  };
  /// What the balance of energy lacks is too near to rounding to tell how it answers σ, relative to the energies.
  static constexpr double near_rounding = 1e-12;
  void start(const SemidiscreteProblem& problem, double step, const State& state);
  /// Forces at the middle and at the end; near the solution also what the energy lacks, and σ for it.
  void evaluate(const SemidiscreteProblem& problem, double step, const State& state, bool near);
  const StageSolution& solve_round(const SemidiscreteProblem& problem, ReactionMean mean, double step,
                                   const State& state, StageSolve& stages);
  [[nodiscard]] bool is_balanced(double step, const State& state, const Round& round, bool near);
  [[nodiscard]] bool correct_velocity(double step, const State& state);
  /// What the balance of energy may lack, relative to the energies.
  [[nodiscard]] double tolerance() const;
  /// What the progress of a round asks for. Throws Error(not_converged).
  [[nodiscard]] bool hold_pairs(const SemidiscreteProblem& problem);
  void heed(const SemidiscreteProblem& problem, NewtonProgress::Advice advice, const Round& round, StageSolve& stages);
  void balance(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage);
  void require_contact(const SemidiscreteProblem& problem, ReactionMean mean, double step, const State& state,
                       StageSolve& stages, Stage& stage);
  Round correct(const SemidiscreteProblem& problem, const State& state, const StageSolution& solution);
  void accelerate(const SemidiscreteProblem& problem, const State& state);
  [[nodiscard]] static double obstacle_work(Stage& stage, const Vector& normal, const Vector& tangential, double step);
  void follow_start(const SemidiscreteProblem& problem, double step, const State& state, StageSolve& stages,
                    Stage& stage, const StageSolution& solution);
  void finish(const SemidiscreteProblem& problem, double step, State& state, Stage& stage,
              const StageSolution& solution, Vector& increment);
  void name_inverted_cell(const SemidiscreteProblem& problem);
  void halve_where_inverted(const SemidiscreteProblem& problem, double step, const State& state, bool near);

  std::unique_ptr<FlightPrediction> flight_;
  std::shared_ptr<const InternalForce> layer_;  ///< of the cells at contact nodes alone
  NewtonProgress progress_;
  EnergySecant sigma_;
  std::unique_ptr<VelocityCorrection> velocity_correction_;
  bool corrects_velocity_ = false, has_told_of_snap_ = false;
  EndContact contact_;
  LaggedRows lagged_;    ///< where rows follow the motion
  Reactions reactions_;  ///< of the round before in this step, if there was one
  bool has_reactions_ = false;
  AndersonAcceleration acceleration_{8};
  StepEquations equations_;
  StepLoads loads_;
  StepCorrections corrections_;
  long energy_step_ = -1;                     ///< the step whose end is known already
  double kept_energy_ = 0.0;                  ///< V there
  std::optional<double> layer_energy_start_;  ///< of the cells at contact nodes, once it is asked for
  double viscous_dissipation_ = 0.0;          ///< 𝒟
  double energy_ = 0.0, energy_start_ = 0.0, lacking_ = 0.0, end_weight_ = 0.0, dissipation_ = 0.0;
  bool converged_ = false;                          ///< places
  double kinetic_start_ = 0.0, kinetic_ = 0.0;      ///< at the ends of the step, the second of the round before
  double lacked_ = 0.0;                             ///< |lacking_| of the round before
  double whole_step_ = 0.0;                         ///< that parts are of
  double part_ = 1.0;                               ///< of it that is taken
  int vain_ = 0;                                    ///< rounds in a row that did not halve it
  double work_at_end_ = 0.0, obstacle_work_ = 0.0;  ///< ρ·HΔ_c less the obstacles' motion; ρ̄ on that
  double load_work_ = 0.0;                          ///< of loads that change, beside their mean on the increment
  Vector base_, middle_, end_, increment_, force_, strain_force_, end_force_, nodal_, mean_nodal_;
  Vector at_start_;  ///< L₀ + P₀ + Hᵀρ
  Vector internal_;  ///< A₁
  Vector relaxed_;   ///< u₀ + J
  Vector product_, right_, layer_right_, damping_force_, before_, last_middle_, last_end_;
  Vector point_, image_;  ///< of a round that is accelerated
  Vector row_force_;      ///< of the reactions along rows that the solver had not
};

}  // namespace ricochet
