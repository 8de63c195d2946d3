#pragma once

#include <string>
#include <vector>

#include "ricochet/scheme/contact_stiffness.hpp"
#include "ricochet/scheme/reduced/end_contact.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/scheme/step_equations.hpp"

/// @file Step of schemes whose contact nodes have no inertia and are in equilibrium at the end of each step, while the
/// other nodes follow the midpoint rule. With c the contact nodes, f the others, ρ = (r_N, −r_T) and H = [G; B_T]:
///   M (v₁−v₀)/h + (2/h) C (x−u₀) + K x = L̄ on f,   x_f = (u_f0 + u_f1)/2,   L̄ = (L₀ + L₁)/2,
///   (2/h) C (x−u₀) + K x = L̄ + Hᵀ ρ̄ on c,
///   (K u₁)_c + (C/h) (u₁ − u₀) on c = L₁ + Hᵀ ρ,   Coulomb's law at the end on the slip of the step.
/// x is the unknown of a stage on the midpoint's operator A = 4M/h² + K + 2C/h, and the contact nodes at the end are at
///   u_c1 = 2 x_c − u_c0 − ℓ Q⁻¹ (r₀ − (η/h)(L₁−L₀) + Hᵀρ) − 2 Q⁻¹ Hᵀ(ρ̄−ρ),   r₀ = L₀ − (K u₀)_c,
/// Q = (K + C/h)_cc with ℓ = 1/(1 + 2η/h) if C_c = ηK_c. If η is not uniform over the contact nodes, the damping at
/// their end is 2C/h, so that Q = A_cc, ℓ = 1 and there is no term with η. ρ̄ ≠ ρ only if η = 0. docs/energy.md derives
/// it, with the balance of energy for η = 0
///   E₁ − E₀ = L̄·Δu + ρ̄·HΔu − ΔuᵀCΔu/h − zᵀ(Hᵀ(ρ̄ − ½ρ) + ½r₀),   K_cc z = (K Δu)_c.
namespace ricochet {

class MasslessContactStep {
 public:
  MasslessContactStep(std::string scheme, double step) : scheme_(std::move(scheme)), step_(step) {}

  /// Throws Error(invalid_input) if contact nodes have inertia. Computes nothing for a nonlinear internal force, whose
  /// steps are those of finite_strain_step.hpp.
  void analyse(const SemidiscreteProblem& problem);
  /// Checks the requirements of schemes whose balance of energy holds without friction, against planes, and without
  /// stiffness damping at contact nodes. To be called after analyse(). Throws Error(invalid_input), which names the
  /// remedy.
  void require_frictionless_planes(const SemidiscreteProblem& problem) const;
  void change_step(const SemidiscreteProblem& problem, double step);
  [[nodiscard]] bool damps_contact_nodes() const { return damps_; }
  /// Operators of the contact nodes and of the midpoint; without contact dofs that of the midpoint alone.
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem& problem,
                                                            ActingReaction acting) const;

  /// Performs a step that is determined by the contact conditions at its end, see above.
  void advance(const SemidiscreteProblem& problem, ActingReaction acting, State& state, StageSolve& stages,
               Vector& increment);
  [[nodiscard]] const StepCorrections& corrections() const { return corrections_; }

  // Parts of a step, for schemes that combine them in another way.
  /// Computes L̄ and base = u₀ + (h/2)v₀, and fills the stage with the balance at the middle.
  void balance(const SemidiscreteProblem& problem, const State& state, Stage& stage);
  [[nodiscard]] const Vector& base() const { return base_; }
  [[nodiscard]] StepEquations& equations() { return equations_; }
  /// Computes r₀, per contact dof.
  void find_residual(const SemidiscreteProblem& problem, const State& state);
  [[nodiscard]] const Vector& residual() const { return residual_; }
  /// L₁ − L₀, per contact dof.
  [[nodiscard]] const Vector& load_change() const { return load_change_; }
  [[nodiscard]] const ContactStiffness& stiffness() const { return stiffness_; }
  /// Number of the stage of the midpoint.
  [[nodiscard]] static std::size_t midpoint_stage(const SemidiscreteProblem& problem) {
    return !problem.has_contact_dofs() ? 0 : condensed_stage + 1;
  }
  static constexpr std::size_t condensed_stage = 0;
  /// Sets the right-hand side of the stage of contact nodes: forces per contact dof, with supports at rest.
  static void set_contact_force(const SemidiscreteProblem& problem, const Vector& force, Stage& stage);
  /// Solves with the operator of contact nodes, without contact. Returns the increment, per dof; `right_hand_side` is
  /// per contact dof.
  static const Vector& solve_contact_nodes(const SemidiscreteProblem& problem, const Vector& right_hand_side,
                                           StageSolve& stages);
  /// Sets u₁, v₁ from δ of the midpoint's stage and the increment of the step.
  void move(const SemidiscreteProblem& problem, const Vector& solution, const Vector& increment, State& state) const;
  /// Transfers the forces of the step to the state; loads are those of the balance.
  void store_forces(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution,
                    const Vector& increment, State& state);
  /// Works zᵀ(Hᵀ(ρ̄ − ½ρ) + ½r₀) and ½ zᵀ(L₁−L₀).
  struct ContactNodeWork {
    double reactions, load;
  };
  /// Computes these works; leaves (K Δu)_c and z, per contact dof.
  [[nodiscard]] ContactNodeWork contact_node_work(const SemidiscreteProblem& problem, const ContactRows& rows,
                                                  const StageSolution& solution, const Vector& increment,
                                                  StageSolve& stages);

 private:
  const StageSolution& solve(const SemidiscreteProblem& problem, const State& state, Stage& stage, StageSolve& stages);
  void find_damping(const SemidiscreteProblem& problem);
  [[nodiscard]] double load_work_of_mean(const SemidiscreteProblem& problem, double mu, double at_end,
                                         StageSolve& stages);
  void correct(const SemidiscreteProblem& problem, ActingReaction acting, const Stage& stage,
               const StageSolution& solution, const Vector& increment, const State& state, StageSolve& stages);

  std::string scheme_;
  double step_;
  bool damps_ = false, one_damping_ = true;
  double eta_ = 0.0;                          ///< η, if uniform
  ContactStiffness stiffness_, damped_rows_;  ///< K_c; K_c + 2C_c/h if η is not uniform
  EndContact contact_;
  StepEquations equations_;
  StepCorrections corrections_;
  Vector load_, base_, residual_, load_change_, contact_right_hand_side_, contact_base_;
  Vector previous_varying_, mean_varying_;             ///< varying load at the start; its mean over the step
  Vector start_displacement_, predicted_end_;          ///< u₀; u₁ of rigid bodies, predicted
  Vector gyroscopic_force_, next_gyroscopic_force_;    ///< contained in b; at the predicted end
  Vector contact_stiffness_force_, static_increment_;  ///< (K Δu)_c per contact dof; K_cc⁻¹ times it
  Vector excess_reaction_force_;                       ///< Hᵀ(ρ̄ − ½ρ)
  Vector gap_change_, slip_change_, normal_, tangential_;
};

}  // namespace ricochet
