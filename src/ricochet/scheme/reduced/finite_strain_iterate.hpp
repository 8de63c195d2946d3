#pragma once

#include <memory>

#include "ricochet/problem/contact_couples.hpp"
#include "ricochet/problem/flight_prediction.hpp"
#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/scheme/reduced/end_contact.hpp"
#include "ricochet/scheme/reduced/step_balance.hpp"
#include "ricochet/scheme/reduced/step_loads.hpp"
#include "ricochet/scheme/step_equations.hpp"
#include "ricochet/step/contact_newton.hpp"
#include "ricochet/step/stage_solve.hpp"

/// @file Iterate of the equations of finite_strain_step.hpp: positions, the forces there, and their balance.
namespace ricochet {

/// A step to be taken.
struct StepTask {
  const SemidiscreteProblem& problem;
  ActingReaction acting;
  double step;   ///< h
  State& state;  ///< at the start of the step; once it is taken, at its end
  StageSolve& stages;

  /// The stage of the middle.
  [[nodiscard]] Stage& middle_stage() const;
};

/// Positions of an iterate, per dof.
struct StepPositions {
  Vector middle;  ///< x
  Vector end;     ///< u₁
};

class FiniteStrainIterate {
 public:
  /// Analyses the problem, once its mass and supports are known, for steps of this full length. Throws
  /// Error(invalid_input).
  void analyse(const SemidiscreteProblem& problem, double step);

  /// Begins a step with the positions of a flight, or with those at its start. Keeps a reference to the task until the
  /// next one. Forces are not evaluated.
  void start(const StepTask& task);
  void start_at_rest(const StepTask& task);
  /// Computes D and f(u₁). Throws Error(not_converged) where a cell is inverted.
  void evaluate();
  /// Moves half of the way back to the last positions.
  void halve();
  /// Raises the rules of path_force() once near the solution and once at it. Returns whether the force has changed.
  [[nodiscard]] bool raise_rules(bool is_solution);
  /// Computes b of a stage, the residual at the middle without forces of contact, and δ at supports.
  void balance_middle(Stage& stage);
  /// Imposes contact at the end where that is u₁ + 2m; conditions that follow the motion are linear about this m.
  void require_contact(const Vector& end, const Vector& linear_about, Stage& stage);
  /// Computes L₁ + P_c(u₁) − f_c(u₁).
  void find_end_residual(Vector& residual) const;
  /// Closes the balance of momentum and energy with the reactions of the last iteration, whose correction had this
  /// size. Returns false if a smaller one is necessary. Throws Error(not_converged).
  [[nodiscard]] bool close_balance(const StageSolution& solution, double correction, bool may_refuse);
  /// Moves the state to the end of the step whose balance is closed.
  void finish(const StageSolution& solution, Vector& increment);

  [[nodiscard]] const StepTask& task() const { return *task_; }
  [[nodiscard]] StepPositions& now() { return now_; }
  [[nodiscard]] const StepPositions& now() const { return now_; }
  /// Positions before the last correction.
  [[nodiscard]] const StepPositions& last() const { return last_; }
  /// Remembers the present positions as the last ones, and returns to these.
  void begin_correction() { last_ = now_; }
  void take_correction_back() { now_ = last_; }
  /// Largest motion of a node since the last positions, and in the increment of the step less that of a free flight:
  /// the effect of forces.
  [[nodiscard]] NewtonEquations::Iteration sizes();
  [[nodiscard]] double rounding_of_positions() const;

  [[nodiscard]] const InternalForce* contact_cells() const { return contact_cells_.get(); }
  [[nodiscard]] const PathRules& path_rules() const { return path_rules_; }
  [[nodiscard]] const Vector& path_increment() const { return path_increment_; }
  [[nodiscard]] const StepCorrections& corrections() const { return balance_.corrections(); }

 private:
  [[nodiscard]] double largest_motion(const Vector& motion) const;
  void find_imbalance(Vector& force);
  void find_residual(const StageSolution& solution, Stage& stage);
  [[nodiscard]] bool any_penetrates(const StageSolution& solution, double correction);

  const StepTask* task_ = nullptr;
  std::unique_ptr<FlightPrediction> flight_;
  std::unique_ptr<ContactCouples> couples_;
  std::shared_ptr<const InternalForce> contact_cells_;  ///< of the cells at contact nodes alone
  PathRules lowest_rules_, path_rules_;                 ///< of D, the latter fixed while the equations are solved
  int raises_ = 0;                                      ///< possible ones so far in this step: near and at its solution
  StepBalance balance_;
  EndContact contact_;
  StepEquations equations_;
  StepLoads loads_;
  double whole_step_ = 0.0;                        ///< length of a full step
  double extent_ = 0.0;                            ///< of the model
  double work_of_mean_ = 0.0, work_at_end_ = 0.0;  ///< ρ̄·HΔ and ρ·HΔ, less the obstacles' motion
  StepPositions now_, last_;
  Vector base_, force_, end_force_, end_contact_force_, mean_contact_force_;
  Vector path_increment_;      ///< u₁ − u⁺
  Vector inertial_increment_;  ///< x − (u₀ + ½h v₀), so that v₁ − v₀ = (4/h)(x − base)
  Vector inertial_force_;      ///< M times that
  Vector half_increment_;      ///< x − u₀
  Vector residual_;            ///< R
  Vector damping_force_, before_;
  Vector gap_;
  Vector motion_;  ///< of an iteration, to be measured
};

/// Common part of the iterations of these equations.
class FiniteStrainEquations : public NewtonEquations {
 public:
  explicit FiniteStrainEquations(FiniteStrainIterate& iterate) : iterate_(iterate) {}
  void evaluate() override { iterate_.evaluate(); }
  void halve() override { iterate_.halve(); }
  [[nodiscard]] bool refine(bool is_solution) override { return iterate_.raise_rules(is_solution); }
  [[nodiscard]] bool has_conditions_on_solution() const override { return true; }
  [[nodiscard]] bool accept(const Iteration& iteration, bool may_refuse) override {
    return iterate_.close_balance(solution(), iteration.correction, may_refuse);
  }
  [[nodiscard]] bool freeze() override { return iterate_.task().problem.contact.freeze_pairs(); }
  /// Reactions of the last iteration.
  [[nodiscard]] virtual const StageSolution& solution() const = 0;

 protected:
  FiniteStrainIterate& iterate_;
};

}  // namespace ricochet
