#pragma once

#include <vector>

#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/solver/delassus/delassus_problem.hpp"

/// @file A stage on the dofs of one factor: forward solve, contact problem, back solve.
namespace ricochet {

class FactoredStage {
 public:
  /// Factorizes. `dofs` are those of the unknowns of `factor`, which has been analysed; `coefficients` are those of A,
  /// for the error. `condensed_stage` is the stage of the operator A_c, if these coefficients name one, whose factor is
  /// used. Keeps references to the problem, to `shared` and to `condensed_stage`. Throws Error(invalid_input) if A is
  /// not positive definite.
  FactoredStage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                const std::vector<int>& dofs, SparseCholesky factor, SharedContact& shared,
                FactoredStage* condensed_stage = nullptr);
  ~FactoredStage() { shared_.factor_entries -= factor_.factor_entries(); }
  FactoredStage(const FactoredStage&) = delete;
  FactoredStage& operator=(const FactoredStage&) = delete;

  /// Computes, from b per dof of the problem, the reactions, and δ on the dofs of the factor. The other entries of
  /// `increment` are unchanged, and are part of the motion by which the gaps of points outside the contact problem are
  /// judged.
  void solve(const LinearStage& stage, const Vector& right_hand_side, StageSolution& solution, Vector& increment);

  /// Refactorizes with other values of A on the dofs of the factor, of the same pattern.
  void refactorize(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                   const SparseMatrix& matrix);

  /// Dofs in the order of the factor.
  [[nodiscard]] const std::vector<int>& dofs() const { return dof_at_; }
  [[nodiscard]] SparseCholesky& factor() { return factor_; }
  /// Saves and loads the data that the contact conditions leave for later stages.
  void persist(const SnapshotVisitor& visit) { contact_.persist(visit); }
  void report() const { contact_.report(); }

 private:
  SharedContact& shared_;
  SparseCholesky factor_;
  std::vector<int> dof_at_;  ///< per row of the factor
  DelassusProblem contact_;
  Vector factor_vector_;
};

}  // namespace ricochet
