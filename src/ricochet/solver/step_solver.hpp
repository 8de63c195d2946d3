#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/linear_algebra/preconditioner_maker.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"

/// @file Solving the stages of a step. A step solver knows nothing of time.
namespace ricochet {

enum class SolverMethod : char {
  automatic,  ///< what takes less time for the steps that are expected, where the factor fits into memory
  direct,     ///< a Cholesky factor, made once: forward solve, contact problem, back solve
  iterative,  ///< conjugate gradients around a direct solve near the contact
};

struct StepSolverOptions {
  SolverMethod method = SolverMethod::automatic;
  /// Of the iterative method: the force that is left over, relative to the forces of the step, in the energy norm.
  double tolerance = 1e-10;
  /// Memory that factors may take, in bytes; 0: half of the machine's.
  double memory = 0.0;
  /// All contact points take part in every contact problem, not only those that may touch. For comparisons.
  bool all_points = false;
  /// Solves that are expected of each operator: what a factorization is worth. 0: nobody knows, and it counts as a
  /// thousand.
  long solves = 0;
  /// What iterations are preconditioned by: "block-jacobi", or a name that `preconditioners` knows; "auto": one of
  /// both, by what is expected to take less time.
  std::string preconditioner = "auto";
  std::shared_ptr<const PreconditionerMaker> preconditioners = {};  ///< null: there are no others
  /// What was chosen before for these operators, one by one: a run that goes on keeps it. Empty: chosen anew.
  std::vector<SolverMethod> chosen = {};
};

/// What was chosen for an operator, and why.
struct ChosenMethod {
  SolverMethod method = SolverMethod::direct;
  std::string reason = {};            ///< the rest of a sentence that begins with the method
  double predicted_entries = 0.0;     ///< of the factor; 0: not asked
  double predicted_operations = 0.0;  ///< of its factorization
  double expected_iterations = 0.0;   ///< of conjugate gradients; 0: not asked
  double ordering_seconds = 0.0;      ///< with the analysis that predicts
  double factorization_seconds = 0.0;
};

/// What the iterative method has done so far.
struct IterationCounts {
  long rounds = 0;     ///< of zones and conjugate gradients in turn
  long gradients = 0;  ///< iterations of conjugate gradients
  IterationCounts& operator+=(const IterationCounts& other) {
    rounds += other.rounds;
    gradients += other.gradients;
    return *this;
  }
};

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
