#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/stage/solver_options.hpp"
#include "ricochet/step/stage.hpp"

/// @file Solvers of the stages of a step, which do not depend on time.
namespace ricochet {

class StepSolver {
 public:
  virtual ~StepSolver() = default;
  /// Solves stage `number` (of the operators given at the start). If its rows follow the motion, they are afterwards
  /// those that hold at the solution. Throws Error(not_converged), which names the failed part.
  virtual void solve(std::size_t number, Stage& stage, StageSolution& solution) = 0;
  /// For a nonlinear internal force: solves the stages of this number with the tangent at this displacement from now
  /// on. Throws Error(invalid_input) if the operator is not positive definite there; the stages must then not be solved
  /// before it has succeeded at another displacement.
  virtual void refactorize(std::size_t number, const Vector& displacement) = 0;
  /// Refactorizes all stages, those of contact nodes alone at another displacement, with the pressure of the last
  /// forces. If some operator is not positive definite there, all are made without the pressure, or at half of the
  /// displacement, or finally for the undeformed body, rotated with the bodies.
  virtual void renew_operators(const Vector& displacement, const Vector& of_contact_nodes) = 0;
  /// Number of iterations of Newton's method that take as long as new factors of all stages, by counted costs.
  [[nodiscard]] virtual double renewal_price() const = 0;
  /// For a nonlinear internal force: rotates the operators with bodies at this displacement. (solve() does so itself
  /// for a stage with a linearization.displacement.)
  virtual void rotate_operators(const Vector& displacement) = 0;
  /// Shows every contact problem solved from now on, with its solution, to the observer; none if it is empty.
  virtual void observe_contact(const ContactObserver& observer) = 0;
  /// Time spent in contact solvers so far, for the summary.
  [[nodiscard]] virtual double contact_seconds() const = 0;
  /// Number of entries of all factors, for the summary.
  [[nodiscard]] virtual std::size_t factor_entries() const = 0;
  /// Iterations of all stages; zero if all are solved directly.
  [[nodiscard]] virtual IterationCounts iteration_counts() const = 0;
  /// Saves and loads the data that stages leave for later ones: guesses, warm starts, the points that may touch. A
  /// solver made for the same operators that has loaded them continues with the same bits. Throws Error(invalid_input)
  /// if the data do not fit.
  virtual void persist(const SnapshotVisitor& visit) = 0;
  /// Method of each operator.
  [[nodiscard]] virtual const std::vector<ChosenMethod>& methods() const = 0;
};

/// Loads the methods of a solver of these operators that was saved, for StepSolverOptions::chosen. Throws
/// Error(invalid_input) if they are not such as make_step_solver chooses.
[[nodiscard]] std::vector<SolverMethod> saved_methods(const SnapshotVisitor& saved,
                                                      const std::vector<OperatorCoefficients>& operators);

/// Computes everything that is constant for these operators. Throws Error(invalid_input), which names the node, if an
/// operator is not positive definite.
[[nodiscard]] std::unique_ptr<StepSolver> make_step_solver(const SemidiscreteProblem& problem,
                                                           const std::vector<OperatorCoefficients>& operators,
                                                           const StepSolverOptions& options = {});

}  // namespace ricochet
