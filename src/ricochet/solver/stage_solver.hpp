#pragma once

#include <memory>
#include <vector>

#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/step_solver.hpp"

/// @file Solvers of the stages of one operator. Everything that is constant is computed when they are made.
namespace ricochet {

class FactoredStage;
class GatheredContact;

class StageSolver {
 public:
  virtual ~StageSolver() = default;
  /// Throws Error(not_converged) which says what failed.
  virtual void solve(const Stage& stage, StageSolution& solution) = 0;
  /// Shows the contact problem of the last solution to the observer, if it had one: where rows follow the motion, only
  /// that of the last round is one of the step.
  virtual void show_contact() const = 0;
  /// As of StepSolver.
  virtual void refactorize(const Vector& displacement) = 0;
  virtual void observe_contact(const ContactObserver& observer) = 0;
  /// As of StepSolver.
  virtual void save(Snapshot& snapshot, const std::string& name) const = 0;
  virtual void load(const Snapshot& snapshot, const std::string& name) = 0;
  [[nodiscard]] virtual double contact_seconds() const = 0;
  [[nodiscard]] virtual std::size_t factor_entries() const = 0;
  [[nodiscard]] virtual IterationCounts iteration_counts() const { return {}; }
  /// The factor of the whole operator, where there is one: what a later stage's layer is solved with.
  [[nodiscard]] virtual FactoredStage* factored() { return nullptr; }
};

/// A on the dofs that a stage solves for, and what its factorization would take.
struct AnalysedOperator {
  std::vector<int> dofs;      ///< ascending
  SparseRowMatrix supported;  ///< A's rows of supported dofs: supports × all dofs
  SparseCholesky factor;      ///< of A on these dofs, analysed
};
[[nodiscard]] AnalysedOperator analyse_operator(const SemidiscreteProblem& problem,
                                                const OperatorCoefficients& coefficients);

/// Forward solve, condensed contact, back solve. `layer`: of A_c, where the coefficients name one; kept. Throws
/// Error(invalid_input) when A is not positive definite.
[[nodiscard]] std::unique_ptr<StageSolver> make_direct_stage(const SemidiscreteProblem& problem,
                                                             const OperatorCoefficients& coefficients,
                                                             AnalysedOperator analysed,
                                                             const StepSolverOptions& options,
                                                             FactoredStage* layer = nullptr);

/// Conjugate gradients on all dofs around a direct solve near the contact. `gathered`: where there are several ranks,
/// and contact on some; kept. The layer is then that of its home.
[[nodiscard]] std::unique_ptr<StageSolver> make_iterative_stage(const SemidiscreteProblem& problem,
                                                                const OperatorCoefficients& coefficients,
                                                                const StepSolverOptions& options,
                                                                FactoredStage* layer = nullptr,
                                                                GatheredContact* gathered = nullptr);

/// Several ranks: a stage on the dofs of contact nodes, by a factor on one of them. Keeps a reference to `gathered`.
[[nodiscard]] std::unique_ptr<StageSolver> make_gathered_stage(const SemidiscreteProblem& problem,
                                                               const OperatorCoefficients& coefficients,
                                                               const StepSolverOptions& options,
                                                               GatheredContact& gathered);

}  // namespace ricochet
