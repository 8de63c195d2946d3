#pragma once

#include <memory>
#include <optional>

#include "ricochet/linear_algebra/qr_anderson_acceleration.hpp"
#include "ricochet/problem/contact_couples.hpp"
#include "ricochet/problem/flight_prediction.hpp"
#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/scheme/reduced/end_contact.hpp"
#include "ricochet/scheme/reduced/finite_strain_tangent.hpp"
#include "ricochet/scheme/reduced/step_balance.hpp"
#include "ricochet/scheme/reduced/step_loads.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/newton_progress.hpp"

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

/// Thresholds of iterations with a proximal weight θ (finite_strain_tangent.hpp), which decreases with the motion of an
/// iteration: implicit steps of a descent, of which the last ones are Newton's (pseudo-transient continuation: C. T.
/// Kelley, D. E. Keyes, SIAM J. Numer. Anal. 35 (1998) 508–523).
struct ProximalThresholds {
  double first = 1.0;                             ///< θ of the first iteration
  double largest_decrease = 0.3, growth = 2.0;    ///< factors of θ from one iteration to the next
  double least = 1e-3;                            ///< θ below which it is zero
  double least_after_failure = 0.1, retry = 4.0;  ///< θ, and its factor, after an iteration that inverts a cell or has
                                                  ///< no solution
  int max_iterations = 60;
};

/// Thresholds of the iterations.
struct FiniteStrainThresholds {
  double near_solution = 1e-2;   ///< correction relative to the increment, at which changes of strains are known
  int max_pair_iterations = 80;  ///< iterations after which pairs of facets that keep changing are frozen
  /// Iterations with a kept factor after which the exact tangent is tried unless fewer are expected to be left, and
  /// after which it is tried in any case.
  int early_iterations = 30, max_early_iterations = 120;
  /// Newton iterations with the exact tangent. None of them asks for a new factor: all have their own.
  NewtonThresholds exact = {.max_iterations = 30, .max_renewals = 0};
  ProximalThresholds proximal = {};
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
  [[nodiscard]] const StepCorrections& corrections() const { return balance_.corrections(); }
  /// Middle x of the last step.
  [[nodiscard]] const Vector& middle() const { return middle_; }

 private:
  struct Iteration {
    double correction = 0.0;  ///< largest motion of a node in the last correction
    double increment = 0.0;   ///< likewise in the increment so far
  };
  class Wait;
  struct Reactions {
    Vector normal, tangential, acting_normal, acting_tangential;
  };
  enum class FailureMode {
    early,  ///< after few iterations, without frozen pairs: something else can be tried
    late
  };
  enum class NewtonStart {
    flight,
    start_of_step,
    descent  ///< from the start of the step, with proximal weights
  };
  [[nodiscard]] static double largest_motion(const SemidiscreteProblem& problem, const Vector& motion);
  [[nodiscard]] double rounding_of_positions(const SemidiscreteProblem& problem) const;
  void advance_with_kept_factor(const SemidiscreteProblem& problem, ActingReaction acting, double step, State& state,
                                StageSolve& stages, FailureMode mode, Vector& increment);
  void advance_with_debt(const SemidiscreteProblem& problem, ActingReaction acting, double step, State& state,
                         StageSolve& stages, FailureMode mode, Vector& increment);
  [[nodiscard]] bool advance_exactly(const SemidiscreteProblem& problem, double step, State& state, StageSolve& stages,
                                     Vector& increment);
  void solve_exactly(const SemidiscreteProblem& problem, double step, State& state, StageSolve& stages,
                     NewtonStart from, Vector& increment);
  Iteration iterate_exactly(const SemidiscreteProblem& problem, double step, const State& state, StageSolve& stages,
                            double proximal_weight = 0.0);
  void descend(const SemidiscreteProblem& problem, double step, const State& state, StageSolve& stages);
  void start(const SemidiscreteProblem& problem, double step, const State& state);
  void evaluate(const SemidiscreteProblem& problem, double step, const State& state);
  void find_imbalance(const SemidiscreteProblem& problem, double step, const State& state, Vector& force);
  const StageSolution& solve_iteration(const SemidiscreteProblem& problem, ActingReaction acting, double step,
                                       const State& state, StageSolve& stages);
  [[nodiscard]] bool raise_rules(const SemidiscreteProblem& problem, bool is_solution);
  /// Holds the present pairs of facets until the end of the step. Returns false if there are none, or if they are held
  /// already.
  [[nodiscard]] bool freeze_pairs(const SemidiscreteProblem& problem);
  /// Follows the advice on the progress of an iteration. Throws Error(not_converged).
  void apply_advice(const SemidiscreteProblem& problem, NewtonProgress::Advice advice, const Iteration& iteration,
                    FailureMode mode, StageSolve& stages);
  void balance_middle(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage);
  void require_balance(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage);
  void require_contact(const SemidiscreteProblem& problem, ActingReaction acting, double step, const State& state,
                       StageSolve& stages, Stage& stage);
  Iteration correct(const SemidiscreteProblem& problem, const State& state, const StageSolution& solution);
  void accelerate(const SemidiscreteProblem& problem, const State& state);
  void find_residual(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage,
                     const StageSolution& solution);
  [[nodiscard]] bool close_balance(const SemidiscreteProblem& problem, double step, const State& state, Stage& stage,
                                   const StageSolution& solution, double correction, NewtonProgress& progress);
  void finish(const SemidiscreteProblem& problem, double step, State& state, Stage& stage,
              const StageSolution& solution, Vector& increment);
  void throw_if_inverted(const SemidiscreteProblem& problem);
  void evaluate_prediction(const SemidiscreteProblem& problem, double step, const State& state);
  /// Evaluates the forces, and halves the last correction as long as it inverts cells. Returns whether it did.
  [[nodiscard]] bool evaluate_with_halving(const SemidiscreteProblem& problem, double step, const State& state);

  FiniteStrainThresholds thresholds_;
  std::unique_ptr<FlightPrediction> flight_;
  std::unique_ptr<ContactCouples> couples_;
  std::shared_ptr<const InternalForce> contact_cells_;  ///< of the cells at contact nodes alone
  PathRules lowest_rules_, path_rules_;                 ///< of D, the latter fixed while the equations are solved
  int raises_ = 0;                                      ///< possible ones so far in this step: near and at its solution
  NewtonProgress progress_;
  StepBalance balance_;
  EndContact contact_;
  Reactions reactions_;  ///< of the previous iteration in this step, if any
  QrAndersonAcceleration acceleration_{NewtonThresholds().stored_iterations};
  FiniteStrainTangent exact_;
  ExactTangent exact_tangent_;
  StageSolution exact_solution_;  ///< of the last iteration with the exact tangent: only its reactions
  NewtonProgress exact_progress_{thresholds_.exact};
  Vector unknowns_;  ///< of the exact tangent
  StepEquations equations_;
  StepLoads loads_;
  double whole_step_ = 0.0;                        ///< length of a full step
  double work_of_mean_ = 0.0, work_at_end_ = 0.0;  ///< ρ̄·HΔ and ρ·HΔ, less the obstacles' motion
  Vector base_, middle_, end_, force_, end_force_, end_contact_force_, mean_contact_force_;
  Vector path_increment_;        ///< u₁ − u⁺
  Vector inertial_increment_;    ///< x − (u₀ + ½h v₀), so that v₁ − v₀ = (4/h)(x − base)
  Vector inertial_force_;        ///< M times that
  Vector half_increment_;        ///< x − u₀
  Vector linearization_motion_;  ///< contact motion about which conditions are linear
  Vector contact_residual_;      ///< L₁ + P_c(u₁) − f_c(u₁) − 2 b_c
  Vector residual_;              ///< R
  Vector next_end_, contact_right_hand_side_, damping_force_, before_, last_middle_, last_end_;
  Vector motion_;         ///< of an iteration, to be measured
  Vector scratch_;        ///< a force that is evaluated for its error alone
  Vector point_, image_;  ///< of an accelerated iteration
};

}  // namespace ricochet
