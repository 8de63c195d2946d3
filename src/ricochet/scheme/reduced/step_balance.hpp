#pragma once

#include <memory>

#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/scheme/last_step.hpp"
#include "ricochet/scheme/reduced/step_loads.hpp"
#include "ricochet/scheme/reduced/velocity_correction.hpp"
#include "ricochet/step/stage.hpp"

/// @file Balance of momentum and energy of a step at finite strain, after its last iteration (finite_strain_step.hpp).
///
/// The iterations leave a residual R of the forces over the step. Velocities at the end then compensate for it, and for
/// all other errors of the balance: momenta change by impulses, and the energy by
///   E₁ − E₀ = work of L̄, supports and damping + ℓ + μ ρ·HΔ − d' − 𝒟,
/// to rounding, with any tolerance (docs/finite-strain-proofs.md). This requires a step with v₁ = 2 (u₁−u₀)/h − v₀ on
/// nodes with inertia.
namespace ricochet {

/// Thresholds of the balance of energy. Defects are relative to max(T₀, T₁) + V₀ + V₁, kinetic and stored energies.
struct EnergyThresholds {
  double tolerance = 1e-15;      ///< defect that velocities need not correct
  double near_rounding = 1e-12;  ///< admissible defect that they cannot correct, if more iterations do not help
  double max_defect = 1e-8;      ///< largest uncorrected defect of a full step; of a part in proportion to its length
  double min_part = 0.1;         ///< least part of a full step that counts in this proportion
  double max_corrected = 1e-3;   ///< largest defect that velocities correct
};

/// Solution of the equations of a step. Vectors are per dof.
struct SolvedStep {
  const SemidiscreteProblem& problem;
  double step;         ///< h
  const State& state;  ///< at the start
  const StepLoads& loads;
  const StageSolution& solution;     ///< reactions of the last iteration
  const Vector& middle;              ///< x
  const Vector& end;                 ///< u₁
  const Vector& path_increment;      ///< u₁ − u⁺, which is u₁ − u₀ except on contact nodes
  const Vector& inertial_increment;  ///< x − (u₀ + ½h v₀), so that v₁ − v₀ = (4/h) times it
  const Vector& inertial_force;      ///< M times that
  const Vector& mean_contact_force;  ///< Hᵀρ̄
  double work_of_mean, work_at_end;  ///< ρ̄·HΔ and ρ·HΔ, less the obstacles' motion
  double max_created_work;           ///< what ρ·HΔ may be beyond 0 because rows are those of the iteration before

  [[nodiscard]] BranchStep branches() const {
    return {middle, path_increment, state.displacement, end, state.internal_strain, step};
  }
};

class StepBalance {
 public:
  enum class Verdict {
    closed,
    open  ///< the step would create energy that velocities cannot supply, or lose it: more accurate iterations may help
  };
  /// Analyses the problem, once its mass and supports are known. Keeps references.
  void analyse(const SemidiscreteProblem& problem, const BodyRotations& bodies);
  /// Begins a step that is this part of a full one.
  void start(const SemidiscreteProblem& problem, const State& state, double part);
  /// Gives the bodies exact momenta and, if they vibrate, an exact balance of energy. `residual`: R of all forces at
  /// the middle, of which the reactions of supports are taken. Throws Error(not_converged) if a cell is inverted at the
  /// end, or if the step creates energy. `may_open`: whether Verdict::open is possible.
  [[nodiscard]] Verdict close(const SolvedStep& solved, Vector& residual, bool may_open);
  /// Records that the step whose balance is closed was taken.
  void finish(const State& state);

  // Results of close():
  [[nodiscard]] const Vector& end_velocity() const { return end_velocity_; }        ///< v₁
  [[nodiscard]] const Vector& velocity_change() const { return velocity_change_; }  ///< v₁ less that of the equations
  [[nodiscard]] const Vector& support_reaction() const { return support_reaction_; }
  [[nodiscard]] const Vector& internal_strain() const { return internal_; }  ///< A₁
  [[nodiscard]] const StepCorrections& corrections() const { return corrections_; }

 private:
  void take_support_reactions(const SemidiscreteProblem& problem, Vector& residual);
  void find_stored_energy(const SolvedStep& solved);
  [[nodiscard]] double find_dissipation(const SolvedStep& solved);
  [[nodiscard]] double correct_momenta(const SolvedStep& solved, const Vector& residual);
  void correct_momenta_of(const FreeMotion& body, const SolvedStep& solved, const Vector& residual);
  [[nodiscard]] double energy_defect(const SolvedStep& solved, double kinetic_change);
  [[nodiscard]] Verdict correct_energy(double defect, double dissipation, double size, bool may_open);

  EnergyThresholds thresholds_;
  std::unique_ptr<VelocityCorrection> velocity_correction_;
  std::shared_ptr<const InternalForce> contact_cells_;  ///< of the cells at contact nodes alone
  StepCorrections corrections_;
  long last_step_ = -1;                           ///< step whose end has been evaluated
  double last_energy_ = 0.0;                      ///< V there
  double energy_start_ = 0.0, energy_end_ = 0.0;  ///< V₀, V₁
  double viscous_dissipation_ = 0.0;              ///< 𝒟
  double part_ = 1.0;                             ///< of a full step
  double end_weight_ = 0.0;                       ///< μ; 0 if nothing presses
  Vector internal_, support_reaction_, end_velocity_, velocity_change_;
  Vector increment_;            ///< Δ
  Vector path_start_;           ///< u⁺
  Vector force_at_start_;       ///< L₀ + P₀ + Hᵀρ̄
  Vector mean_external_force_;  ///< L̄ + P(x) + Hᵀρ̄
  Vector damping_force_;        ///< C Δ
  Vector momentum_change_;      ///< M times the change of the velocity
};

}  // namespace ricochet
