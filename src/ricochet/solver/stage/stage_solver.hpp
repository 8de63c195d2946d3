#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/stage/shared_contact.hpp"
#include "ricochet/solver/stage/solver_options.hpp"
#include "ricochet/step/stage.hpp"

/// @file Interface of the solvers of the stages of one operator. Everything that is constant is computed in their
/// constructors.
namespace ricochet {

class FactoredStage;

class StageSolver {
 public:
  virtual ~StageSolver() = default;
  /// Throws Error(not_converged), which names the failed part.
  virtual void solve(const LinearStage& stage, StageSolution& solution) = 0;
  /// Shows the contact problem of the last solution to the observer, if it had one: for rows that follow the motion,
  /// only that of the last iteration belongs to the step.
  virtual void show_contact() const = 0;
  /// Refactorizes as StepSolver does.
  virtual void refactorize(const Vector& displacement) = 0;
  /// Saves and loads as StepSolver does.
  virtual void persist(const SnapshotVisitor& visit) = 0;
  [[nodiscard]] virtual IterationCounts iteration_counts() const { return {}; }
  /// Factor of the whole operator, if there is one, for later stages with massless contact nodes.
  [[nodiscard]] virtual FactoredStage* factored() { return nullptr; }
};

}  // namespace ricochet
