#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "ricochet/scheme/scheme.hpp"
#include "ricochet/simulation/history/energy_account.hpp"
#include "ricochet/simulation/monitor/tunnelling_watch.hpp"
#include "ricochet/simulation/part_lengths.hpp"
#include "ricochet/simulation/statics/starting_state.hpp"
#include "ricochet/simulation/step_control.hpp"
#include "ricochet/solver/exact/exact_stage.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file Time stepping of a problem with a scheme.
namespace ricochet {

class Simulation : private StageSolve {
 public:
  /// Finds the starting state and factorizes the scheme's operators. Keeps references to both arguments. With `control`
  /// the step lengths follow the motion; throws Error(invalid_input) if the scheme cannot change its step length.
  Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const InitialConditions& initial,
             const StepSolverOptions& options = {}, const std::optional<StepControlOptions>& control = {});

  /// Resumes from a snapshot written by save(): the following steps have the same bits as without the interruption.
  /// Throws Error(invalid_input) if the snapshot does not fit.
  Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const Snapshot& snapshot,
             const StepSolverOptions& options = {}, const std::optional<StepControlOptions>& control = {});
  void save(Snapshot& snapshot);

  /// Advances the state by one step. Throws Error(not_converged), which names the step and its time; the state is then
  /// that before the step, except if adaptive steps stop because the scheme has created most of the energy. At finite
  /// strain, or with contact that follows the motion, a step of fixed length without a solution is divided by halving
  /// if the scheme can change its step length, and the next step begins with the length that this one needed. Calls
  /// `each_part` after the step, or after each of its parts.
  void advance(const std::function<void(const State&)>& each_part = {});

  /// Changes the velocity of the body (per dof), as an instantaneous impulse would; the work of the loads then contains
  /// the change of energy. Returns the impulse, per dof. Supported and tied dofs keep the velocity that is prescribed
  /// for them.
  Vector set_velocity(const Vector& velocity);

  /// Passes the contact problems of the following steps and their solutions to the observer; an empty one ends this.
  void observe_contact(const ContactObserver& observer);

  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] EnergyAccount& account() { return *account_; }
  [[nodiscard]] const Vector& increment() const { return increment_; }
  /// Step control; null if all steps have the same length.
  [[nodiscard]] const StepControl* control() const { return control_ ? &*control_ : nullptr; }
  /// Number of steps that were divided into parts so far.
  [[nodiscard]] long cut_steps() const { return cut_steps_; }
  /// Number of entries of the factors of all operators.
  [[nodiscard]] std::size_t factor_entries() const;
  [[nodiscard]] double contact_seconds() const;
  [[nodiscard]] IterationCounts iteration_counts() const;
  [[nodiscard]] const std::vector<ChosenMethod>& methods() const { return current_->solver->methods(); }

 private:
  Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const StepSolverOptions& options,
             const std::optional<StepControlOptions>& control);
  /// Stage of the step and its solution.
  struct SolvedStage {
    Stage stage;
    StageSolution solution;
    StageDofs dofs = StageDofs::all;  ///< dofs that it solves for
  };
  /// Solver and stages for steps of one length.
  struct Level {
    std::unique_ptr<StepSolver> solver;
    std::vector<SolvedStage> stages;
    bool has_failed = false;  ///< whether the last attempt at this length, with the tangent at its start, failed
  };
  void persist(const SnapshotVisitor& visit);
  void persist_levels(const SnapshotVisitor& visit);
  Level& make_level(int level, const StepSolverOptions& options);
  void use_level(int level);
  void set_up_tunnelling_watches();
  void take_step(bool is_shortest);
  /// Throws Error(invalid_input) if initial displacements turn a cell inside out.
  void require_upright_start() const;
  [[nodiscard]] bool is_distorted(double limit) const;
  bool control_distortion() const;
  void solve_step();
  void attempt_step();
  [[nodiscard]] const char* failure_reason() const;
  void warn_of_short_parts();
  bool take_fixed_step(const std::function<void(const State&)>& each_part);
  bool forget_parts(const std::function<void(const State&)>& each_part);
  bool take_whole_step();
  void take_step_in_parts(const std::function<void(const State&)>& each_part);
  [[nodiscard]] double length_of(int level) const;
  void end_part(const std::function<void(const State&)>& each_part);
  void complete_tied();
  /// Returns kinetic and elastic energy at the end of the step.
  double take_controlled_step();
  [[nodiscard]] double energy_of_motion() const;
  /// Passes the energy at the end of a trial step of the longest length to the step control.
  void take_trial_step();
  Stage& stage(std::size_t number) override;
  [[nodiscard]] double newton_tolerance() const override { return options_.newton_tolerance; }
  const StageSolution& solve(std::size_t number) override;
  [[nodiscard]] bool may_be_shortened() const override { return !is_shortest_; }
  [[nodiscard]] bool solves_exactly() const override { return !problem_.ranks->are_several(); }
  void solve_exactly(std::size_t number, ExactTangent& tangent, StageSolution& solution, Vector& unknowns) override;
  [[nodiscard]] double renewal_price() const override { return current_->solver->renewal_price(); }
  void rotate_operators(const Vector& displacement) override { current_->solver->rotate_operators(displacement); }
  void renew_operators(const Vector& displacement, const Vector& of_contact_nodes) override {
    current_->solver->renew_operators(displacement, of_contact_nodes);
  }

  const SemidiscreteProblem& problem_;
  Index contact_points_;  ///< on all ranks
  Scheme& scheme_;
  State state_;
  StepSolverOptions options_;
  ContactObserver observer_;
  std::map<int, Level> levels_;  ///< by k, for steps of length H 2^-k; without control H is the whole step
  Level* current_ = nullptr;
  ExactStage exact_stage_{problem_};
  std::optional<StepControl> control_;
  double whole_step_;         ///< length, without control
  PartLengths part_lengths_;  ///< without control
  long cut_steps_ = 0;
  bool is_shortest_ = false;  ///< the step that is being solved is not divided any more
  bool short_parts_warned_ = false;
  std::vector<TunnellingWatch> guards_;  ///< contact nodes and points, each against the obstacle that they touch
  bool has_guards_ = false;              ///< on this or another rank
  State unguarded_;                      ///< state at the start of a step that may be refused
  bool has_tunnelled_ = false;           ///< true if the last attempt was refused for tunnelling
  State state_before_attempt_;           ///< state before an attempt, with control
  std::unique_ptr<EnergyAccount> account_;
  int iterations_ = 0;         ///< of the contact solver in the last attempt
  int newton_iterations_ = 0;  ///< Newton iterations, of all attempts and parts of this step
  Vector increment_;
};

}  // namespace ricochet
