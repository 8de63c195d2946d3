#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/scheme/scheme.hpp"
#include "ricochet/simulation/history/energy_account.hpp"
#include "ricochet/simulation/monitor/passage_watch.hpp"
#include "ricochet/simulation/statics/starting_state.hpp"
#include "ricochet/simulation/step_control.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file A problem, a scheme and a state, step by step.
namespace ricochet {

class Simulation : private StageSolve {
 public:
  /// Finds the starting state and factorizes the scheme's operators. Keeps references to both arguments. With `control`
  /// the lengths of steps follow the motion; throws Error(invalid_input) where the scheme cannot change them.
  Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const InitialConditions& initial,
             const StepSolverOptions& options = {}, const std::optional<StepControlOptions>& control = {});

  /// Goes on from what save() has put into a snapshot: steps give the same bits as if there had been no interruption.
  /// Throws Error(invalid_input) where it does not fit.
  Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const Snapshot& snapshot,
             const StepSolverOptions& options = {}, const std::optional<StepControlOptions>& control = {});
  void save(Snapshot& snapshot) const;

  /// One step. Throws Error(not_converged) with the step and its time; the state is then that before the
  /// step, but where steps are adaptive and the scheme has created most of the energy. At finite strain a step of fixed
  /// length for which Newton's method finds nothing is taken in parts, by halves, where the scheme changes its step.
  /// `each_part` is called after the step, and after each of its parts.
  void advance(const std::function<void(const State&)>& each_part = {});

  /// Gives the body another velocity (per dof) from here on, as an impulse at once would: what the loads' work then
  /// contains. Returns the impulse, per dof. Prescribed and tied dofs keep to what they follow.
  Vector set_velocity(const Vector& velocity);

  /// Shows the contact problems of the next steps, and their solutions, to the observer; none if it is empty.
  void observe_contact(const ContactObserver& observer);

  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] EnergyAccount& account() { return *account_; }
  [[nodiscard]] const Vector& increment() const { return increment_; }
  /// Null where all steps are of one length.
  [[nodiscard]] const StepControl* control() const { return control_ ? &*control_ : nullptr; }
  /// Steps that were taken in parts so far.
  [[nodiscard]] long cut_steps() const { return cut_steps_; }
  /// Of all operators that were factorized.
  [[nodiscard]] std::size_t factor_entries() const;
  [[nodiscard]] double contact_seconds() const;
  [[nodiscard]] IterationCounts iteration_counts() const;
  [[nodiscard]] const std::vector<ChosenMethod>& methods() const { return current_->solver->methods(); }

 private:
  /// A stage of the step with what it gave.
  struct SolvedStage {
    Stage stage;
    StageSolution solution;
    StageDofs dofs = StageDofs::all;  ///< that it solves for
  };
  /// Steps of one length.
  struct Level {
    std::unique_ptr<StepSolver> solver;
    std::vector<SolvedStage> stages;
  };
  Level& make_level(int level, const StepSolverOptions& options);
  void use_level(int level);
  void guard_passages();
  void take_step(bool is_shortest);
  void solve_step();
  void attempt_step();
  [[nodiscard]] const char* why_no_solution() const;
  void tell_short_parts(int level);
  void take_step_in_parts(const std::function<void(const State&)>& each_part);
  [[nodiscard]] double length_of(int level) const;
  void end_part(const std::function<void(const State&)>& each_part);
  void complete_tied();
  /// Returns kinetic and elastic energy at its end.
  double take_controlled_step();
  [[nodiscard]] double energy_of_motion() const;
  /// Tells the control what a step of the longest length would end with.
  void look_ahead();
  Stage& stage(std::size_t number) override;
  const StageSolution& solve(std::size_t number) override;
  void follow(const Vector& displacement) override { current_->solver->follow(displacement); }
  void renew(const Vector& displacement, const Vector& of_contact_nodes) override {
    current_->solver->renew(displacement, of_contact_nodes);
  }

  const SemidiscreteProblem& problem_;
  Index contact_points_;  ///< of all ranks
  Scheme& scheme_;
  State state_;
  StepSolverOptions options_;
  ContactObserver observer_;
  std::map<int, Level> levels_;  ///< by the control's number; without control 0, and −log₂ of parts of a step
  Level* current_ = nullptr;
  std::optional<StepControl> control_;
  double whole_step_;  ///< without control
  long cut_steps_ = 0;
  bool told_short_parts_ = false;
  std::vector<PassageWatch> guards_;  ///< of contact nodes, each for the obstacle that they touch
  bool has_guards_ = false;           ///< here or on other ranks
  State unguarded_;                   ///< the start of a step, where there are guards
  bool goes_through_ = false;         ///< the last attempt was refused for that
  State before_;                      ///< an attempt, with control
  std::unique_ptr<EnergyAccount> account_;
  int iterations_ = 0;     ///< of the contact solver in this step
  int newton_rounds_ = 0;  ///< in all attempts and parts of this step
  Vector increment_;
};

}  // namespace ricochet
