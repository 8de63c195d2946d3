#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/delassus/delassus_columns.hpp"
#include "ricochet/step/stage.hpp"

/// @file Massless contact nodes in the contact conditions of a stage (stage.hpp): m = δ − ½ A_c⁻¹ Hᵀ (ℓρ + 2(ρ̄ − ρ)),
/// and V = H A_c⁻¹ Hᵀ on the candidates for contact.
namespace ricochet {

class FactoredStage;

class MasslessContactNodes {
 public:
  /// `coefficients` are those of the stage with massless contact nodes, `condensed_stage` is the stage of A_c; if that
  /// is refactorized, the other is refactorized after it. Keeps references to the problem and the stage of A_c.
  MasslessContactNodes(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                       FactoredStage& condensed_stage);

  /// Weight ℓ.
  [[nodiscard]] double weight() const { return weight_; }
  [[nodiscard]] ActingReaction acting() const { return acting_; }
  /// Per dof of the problem: its number among the unknowns of A_c, or −1.
  [[nodiscard]] const std::vector<int>& unknown() const { return unknown_; }
  [[nodiscard]] Index size() const;

  /// `append` extends V by rows of H, passed as the columns of a `size()` × rows matrix; `renew` recomputes the changed
  /// ones.
  void append(const SparseMatrix& transposed) { columns_.append(transposed, compliance_); }
  void renew(const SparseMatrix& transposed, const std::vector<char>& is_new) {
    columns_.renew(transposed, is_new, compliance_);
  }
  void clear();
  /// V, rows × rows, in length/force, with the factor's power of two removed.
  [[nodiscard]] Matrix compliance() const;

  /// Computes m on contact nodes, from δ per dof and the reactions of a solution; zero elsewhere from the first call
  /// on.
  void find_motion(const ContactRows& rows, const StageSolution& solution, const Vector& increment, Vector& motion);

 private:
  double weight_;
  ActingReaction acting_;
  const SemidiscreteProblem& problem_;
  SparseCholesky& factor_;
  const std::vector<int>& dof_at_;
  std::vector<int> unknown_;
  std::vector<Index> node_dofs_;  ///< of contact nodes, including supported ones
  DelassusColumns columns_;
  Matrix compliance_;  ///< of 2ᵏA_c
  Vector normal_, tangential_, force_, factor_vector_;
};

/// Eligible points with a normal reaction at the start of a step, which a mean contains wherever the points move; empty
/// if the end reactions act.
inline std::vector<Index> pressing_at_start(ActingReaction acting, const LinearStage& stage) {
  std::vector<Index> result;
  if (acting == ActingReaction::end) return result;
  for (Index i = 0; i < stage.start.normal_reaction.size(); ++i) {
    if (stage.start.normal_reaction[i] > 0.0 && stage.conditions.eligible[std::size_t(i)] != 0) result.push_back(i);
  }
  return result;
}

}  // namespace ricochet
