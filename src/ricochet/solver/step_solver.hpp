#pragma once

#include <memory>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/stage.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"

/// @file Solving the stages of a step. A step solver knows nothing of time.
namespace ricochet {

class StepSolver {
 public:
  virtual ~StepSolver() = default;
  /// Solves stage `number` (of the operators given at the start). Throws Error(not_converged) which says what failed.
  virtual void solve(std::size_t number, const Stage& stage, StageSolution& solution) = 0;
  /// Shows every contact problem that is solved from now on, and its solution, to the observer; none if it is empty.
  virtual void observe_contact(const ContactObserver& observer) = 0;
  /// Spent so far in contact solvers, for the summary.
  [[nodiscard]] virtual double contact_seconds() const = 0;
  /// Entries of all factors, for the summary.
  [[nodiscard]] virtual std::size_t factor_entries() const = 0;
};

/// Factorizes each operator once (supernodal Cholesky, contact dofs last) and condenses contact on the contact dofs:
/// forward solve → dense contact problem on the trailing block → back solve.
/// Throws Error(invalid_input) when an operator is not positive definite, with the dof at which this shows.
[[nodiscard]] std::unique_ptr<StepSolver> make_direct_step_solver(const SemidiscreteProblem& problem,
                                                                  const std::vector<OperatorCoefficients>& operators);

}  // namespace ricochet
