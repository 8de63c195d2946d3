#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/stage/solver_options.hpp"

/// @file Solving the stages of a step. A step solver knows nothing of time.
namespace ricochet {

class StepSolver {
 public:
  virtual ~StepSolver() = default;
  /// Solves stage `number` (of the operators given at the start). Where its rows follow the motion they are,
  /// afterwards, those that hold at the solution. Throws Error(not_converged) which says what failed.
  virtual void solve(std::size_t number, Stage& stage, StageSolution& solution) = 0;
  /// Where the internal force is not linear: the stages of this number are solved with the tangent at this displacement
  /// from now on. Throws Error(invalid_input) when the operator is not positive definite there; the stages are then not
  /// to be solved before another displacement has been given at which it is.
  virtual void refactorize(std::size_t number, const Vector& displacement) = 0;
  /// The same of all stages, those of contact nodes alone at another displacement, with the pressure of the last
  /// forces. Where some operator is not positive definite there, all are made without the pressure, or at half of the
  /// displacement, or, if that does not help, of the undeformed body, turned as the bodies are.
  virtual void renew(const Vector& displacement, const Vector& of_contact_nodes) = 0;
  /// Where the internal force is not linear: operators turn with bodies that are at this displacement. (solve() does
  /// so by itself for a stage with a force_place.)
  virtual void follow(const Vector& displacement) = 0;
  /// Shows every contact problem that is solved from now on, and its solution, to the observer; none if it is empty.
  virtual void observe_contact(const ContactObserver& observer) = 0;
  /// Spent so far in contact solvers, for the summary.
  [[nodiscard]] virtual double contact_seconds() const = 0;
  /// Entries of all factors, for the summary.
  [[nodiscard]] virtual std::size_t factor_entries() const = 0;
  /// Of all stages; zero where all are solved directly.
  [[nodiscard]] virtual IterationCounts iteration_counts() const = 0;
  /// What stages have left for later ones: guesses, warm starts, the points that may touch. A solver made for the same
  /// operators that has loaded it goes on with the same bits.
  virtual void save(Snapshot& snapshot, const std::string& name) const = 0;
  /// Throws Error(invalid_input) where it does not fit.
  virtual void load(const Snapshot& snapshot, const std::string& name) = 0;
  /// Per operator.
  [[nodiscard]] virtual const std::vector<ChosenMethod>& methods() const = 0;
};

/// The methods of the solver of so many operators that was saved under this name, for StepSolverOptions::chosen. Throws
/// Error(invalid_input) where there are not so many.
[[nodiscard]] std::vector<SolverMethod> saved_methods(const Snapshot& snapshot, const std::string& name,
                                                      std::size_t operators);

/// Everything that is constant for these operators is computed now. Throws Error(invalid_input) when an operator is not
/// positive definite, with the node at which this shows.
[[nodiscard]] std::unique_ptr<StepSolver> make_step_solver(const SemidiscreteProblem& problem,
                                                           const std::vector<OperatorCoefficients>& operators,
                                                           const StepSolverOptions& options = {});

}  // namespace ricochet
