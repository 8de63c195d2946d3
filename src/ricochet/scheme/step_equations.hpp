#pragma once

#include "ricochet/scheme/last_step.hpp"
#include "ricochet/step/stage.hpp"
#include "ricochet/step/stage_solve.hpp"

/// @file Terms that all schemes share: balance and contact conditions of stages, and the transfer of solutions.
namespace ricochet {

/// Momentum equation and contact conditions of a stage at an instant t of the step,
///   M A + C V + K x = L(t) + Gᵀ r_N − B_Tᵀ r_T,   x = base + δ,   V = v + η δ,
/// and transfer of the forces of its solution to the state. Keeps its storage from step to step.
class StepEquations {
 public:
  /// Sets b = L(t) − f(base), f the internal force, with follower loads evaluated at the base. M A does not contribute
  /// to b: bases are chosen accordingly.
  void balance(const SemidiscreteProblem& problem, double time, const Vector& base, Stage& stage);
  /// Sets b = load − f(base) − C v, for loads that do not belong to one instant.
  void balance_with(const SemidiscreteProblem& problem, const Vector& load, const Vector& base, const Vector& velocity,
                    Stage& stage);
  /// f(base) of the last balance.
  [[nodiscard]] const Vector& internal_force() const { return force_; }
  /// Sets b = L(t) − f(base) − C v.
  void balance(const SemidiscreteProblem& problem, double time, const Vector& base, const Vector& velocity,
               Stage& stage);

  /// Sets δ on supported dofs: increment(dof, prescribed displacement at `time`).
  template <class Increment>
  void prescribe(const SemidiscreteProblem& problem, double time, const Increment& increment, Vector& prescribed) {
    problem.supports.values(time, prescribed);
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[std::size_t(i)];
      prescribed[i] = increment(dof, prescribed[i]);
    }
  }
  template <class Increment>
  void prescribe(const SemidiscreteProblem& problem, double time, const Increment& increment, Stage& stage) {
    prescribe(problem, time, increment, stage.right_hand_side.prescribed);
  }

  /// Sets δ on supported dofs such that they reach their prescribed displacements at `time` from the base.
  void prescribe_from(const SemidiscreteProblem& problem, double time, const Vector& base, Stage& stage) {
    prescribe(
        problem, time, [&](Index dof, double value) { return value - base[dof]; }, stage);
  }

  /// Observes the obstacles' mean velocities over a step from one displacement to another, with the points half way. A
  /// stage whose gaps are those of the end follows the points there. See also evaluate_obstacle_velocity().
  void observe_step(const SemidiscreteProblem& problem, const Vector& start, double start_time, const Vector& end,
                    double step, Stage& stage);
  /// Imposes Newton's impact law at the points that touch at `displacement` and `time`, with the obstacles observed and
  /// one coefficient of restitution e: y = G (after + gap_factor δ) + e G before, for velocities relative to the
  /// obstacles. Velocities are differences of displacements over `step`.
  void require_impact_law(const SemidiscreteProblem& problem, const Vector& displacement, double time,
                          const Vector& after, const Vector& before, double gap_factor, double restitution, double step,
                          Stage& stage);
  /// Imposes Coulomb's law on the slip rate B_T (velocity + slip_factor δ) relative to the observed obstacles, in
  /// stages in which y is a velocity, too: both have the rounding of displacements over a step.
  static void require_friction_beside_rates(const SemidiscreteProblem& problem, const Vector& velocity,
                                            double slip_factor, Stage& stage);
  /// Imposes it on the mean slip rate B_T ΔU/h of the step, ΔU = predicted + δ; that of the obstacles is at its middle.
  void require_friction_over_step(const SemidiscreteProblem& problem, const State& state, const Vector& predicted,
                                  double step, Stage& stage);

  /// Transfers to the state reactions, contact status and the motion of the obstacles over the step; the loads at the
  /// instant of the last balance(); and the damping force at that instant, rate · C motion.
  void store_forces(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution, double step,
                    const Vector& motion, double rate, State& state) const;
  /// Transfers the contact data alone.
  static void store_contact(const Stage& stage, const StageSolution& solution, double step, State& state);
  /// Transfers, like store_forces(), the forces of a stage that are not those of the state.
  void store_other_stage(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution,
                         double step, const Vector& motion, double rate, OtherStageForces& part) const;

 private:
  /// Subtracts the damping force C v from the right-hand side.
  void resist(const SemidiscreteProblem& problem, const Vector& velocity, Stage& stage);
  void store_loads(const SemidiscreteProblem& problem, const StageSolution& solution, const Vector& motion, double rate,
                   StepForces& forces) const;
  static void store_reactions(const Stage& stage, const StageSolution& solution, double step, StepForces& forces,
                              ObstacleMotion& travel);

  double time_ = 0.0;
  Vector force_, damping_force_, middle_, rate_;
  ObstacleMotion impact_;
};

/// Returns a stage without loads: b = 0, δ = 0 on supported dofs. Its rows and contact conditions are unchanged.
Stage& unloaded_stage(const SemidiscreteProblem& problem, std::size_t number, StageSolve& stages);

/// Returns yᵀ K x for a linear internal force. `force` is work space and receives K x.
[[nodiscard]] double elastic_product(const SemidiscreteProblem& problem, const Vector& x, const Vector& y,
                                     Vector& force);

/// Sets A = 0 and V = ΔU/h on dofs without inertia, on which A and V are not state variables.
void follow_without_inertia(const SemidiscreteProblem& problem, const Vector& increment, double step, State& state);

}  // namespace ricochet
