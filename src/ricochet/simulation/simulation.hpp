#pragma once

#include <memory>
#include <vector>

#include "ricochet/scheme/scheme.hpp"
#include "ricochet/simulation/energy_account.hpp"
#include "ricochet/simulation/starting_state.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file A problem, a scheme and a state, step by step.
namespace ricochet {

class Simulation : private StageSolve {
 public:
  /// Finds the starting state and factorizes the scheme's operators. Keeps references to both arguments.
  Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const InitialConditions& initial,
             const StepSolverOptions& options = {});

  /// Goes on from what save() has put into a snapshot: steps give the same bits as if there had been no interruption.
  /// Throws Error(invalid_input) where it does not fit.
  Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const Snapshot& snapshot,
             const StepSolverOptions& options = {});
  void save(Snapshot& snapshot) const;

  /// One step. Throws Error(not_converged) with the step, its time and what to try; the state is then that before the
  /// step.
  void advance();

  /// Shows the contact problems of the next steps, and their solutions, to the observer; none if it is empty.
  void observe_contact(const ContactObserver& observer) { solver_->observe_contact(observer); }

  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] EnergyAccount& account() { return *account_; }
  [[nodiscard]] const Vector& increment() const { return increment_; }
  [[nodiscard]] std::size_t factor_entries() const { return solver_->factor_entries(); }
  [[nodiscard]] double contact_seconds() const { return solver_->contact_seconds(); }
  [[nodiscard]] const std::vector<ChosenMethod>& methods() const { return solver_->methods(); }

 private:
  /// A stage of the step with what it gave.
  struct SolvedStage {
    Stage stage;
    StageSolution solution;
    StageDofs dofs = StageDofs::all;  ///< that it solves for
  };
  void make_solver(const StepSolverOptions& options);
  Stage& stage(std::size_t number) override;
  const StageSolution& solve(std::size_t number) override;

  const SemidiscreteProblem& problem_;
  Scheme& scheme_;
  State state_;
  std::unique_ptr<StepSolver> solver_;
  std::unique_ptr<EnergyAccount> account_;
  std::vector<SolvedStage> stages_;
  int iterations_ = 0;  ///< of the contact solver in this step
  Vector increment_;
};

}  // namespace ricochet
