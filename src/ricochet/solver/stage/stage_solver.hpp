#pragma once

#include <memory>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"
#include "ricochet/solver/stage/solver_options.hpp"

/// @file Interface of the solvers of the stages of one operator. Everything that is constant is computed when they are
/// made.
namespace ricochet {

class FactoredStage;

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

}  // namespace ricochet
