#pragma once

#include "ricochet/problem/stage.hpp"
#include "ricochet/scheme/stage_solve.hpp"
#include "ricochet/scheme/step_part.hpp"

/// @file What every scheme says of its stages, and takes from them: written once.
namespace ricochet {

/// The momentum equation and the contact conditions of a stage at an instant t of the step,
///   M A + C V + K x = L(t) + Gᵀ r_N − B_Tᵀ r_T,   x = base + δ,   V = v + η δ,
/// and the forces that its solution leaves in the state. Keeps its storage from step to step.
class StepEquations {
 public:
  /// b = L(t) − f(base), f the internal force, with the loads that follow the surface as they are at the base. M A has
  /// no part in b: bases are chosen so.
  void balance(const SemidiscreteProblem& problem, double time, const Vector& base, Stage& stage);
  /// b = load − f(base) − C v, with loads that are no instant's.
  void balance_with(const SemidiscreteProblem& problem, const Vector& load, const Vector& base, const Vector& velocity,
                    Stage& stage);
  /// f(base) of the last balance.
  [[nodiscard]] const Vector& internal_force() const { return force_; }
  /// b = L(t) − f(base) − C v.
  void balance(const SemidiscreteProblem& problem, double time, const Vector& base, const Vector& velocity,
               Stage& stage);

  /// δ on supported dofs: increment(dof, prescribed displacement at `time`).
  template <class Increment>
  void prescribe(const SemidiscreteProblem& problem, double time, const Increment& increment, Vector& prescribed) {
    problem.supports.values(time, prescribed);
    for (Index i = 0; i < problem.supports.size(); ++i) {
      const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
      prescribed[i] = increment(dof, prescribed[i]);
    }
  }
  template <class Increment>
  void prescribe(const SemidiscreteProblem& problem, double time, const Increment& increment, Stage& stage) {
    prescribe(problem, time, increment, stage.prescribed);
  }

  /// The same with the base: supported dofs get to where they are prescribed at `time`.
  void prescribe_from(const SemidiscreteProblem& problem, double time, const Vector& base, Stage& stage) {
    prescribe(
        problem, time, [&](Index dof, double place) { return place - base[dof]; }, stage);
  }

  /// The obstacles' mean velocities over a step from one displacement to another, where the points are in its middle. A
  /// stage whose gaps are those of the end follows the points there. Beside it, see observe_obstacles().
  void observe_step(const SemidiscreteProblem& problem, const Vector& start, double start_time, const Vector& end,
                    double step, Stage& stage);
  /// Newton's impact law at the points that touch at `place` and `time`, with the obstacles observed and one
  /// coefficient of restitution e: y = G (after + s δ) + e G before, of velocities relative to the obstacles.
  /// Velocities are differences of displacements over `step`. The caller sets s.
  void require_impact_law(const SemidiscreteProblem& problem, const Vector& place, double time, const Vector& after,
                          const Vector& before, double restitution, double step, Stage& stage);
  /// Coulomb's law on the slip rate B_T (velocity + slip_factor δ) relative to the obstacles observed, where y is a
  /// velocity, too: both round as displacements over a step do.
  static void require_friction_beside_rates(const SemidiscreteProblem& problem, const Vector& velocity,
                                            double slip_factor, Stage& stage);
  /// The same on the mean slip rate B_T ΔU/h of the step, ΔU = predicted + δ; the obstacles' at its middle.
  void require_friction_over_step(const SemidiscreteProblem& problem, const State& state, const Vector& predicted,
                                  double step, Stage& stage);

  /// Reactions, contact status and the motion of the obstacles over the step; the loads at the instant of the last
  /// balance(), and the damping force there, rate · C motion.
  void take_forces(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution, double step,
                   const Vector& motion, double rate, State& state) const;
  /// The reactions alone.
  static void take_contact(const Stage& stage, const StageSolution& solution, double step, State& state);
  /// The same as take_forces of a stage whose forces are not those of the state.
  void take_part(const SemidiscreteProblem& problem, const Stage& stage, const StageSolution& solution, double step,
                 const Vector& motion, double rate, StepPart& part) const;

 private:
  /// Takes the damping force C v from the right-hand side.
  void resist(const SemidiscreteProblem& problem, const Vector& velocity, Stage& stage);
  void take_loads(const SemidiscreteProblem& problem, const StageSolution& solution, const Vector& motion, double rate,
                  StepForces& forces) const;
  static void take_reactions(const Stage& stage, const StageSolution& solution, double step, StepForces& forces,
                             ObstacleMotion& travel);

  double time_ = 0.0;
  Vector force_, damping_force_, middle_, rate_;
  ObstacleMotion impact_;
};

/// A stage on which nothing acts: b = 0, δ = 0 on supported dofs. Its rows and contact conditions are as they were.
Stage& unloaded_stage(const SemidiscreteProblem& problem, std::size_t number, StageSolve& stages);

/// yᵀ K x where the internal force is linear. `force`: work space, receives K x.
[[nodiscard]] double elastic_product(const SemidiscreteProblem& problem, const Vector& x, const Vector& y,
                                     Vector& force);

/// On dofs without inertia A and V are no states: A = 0, V = ΔU/h.
void follow_without_inertia(const SemidiscreteProblem& problem, const Vector& increment, double step, State& state);

}  // namespace ricochet
