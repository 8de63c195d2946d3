#pragma once

#include <vector>

#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/solver/condensed_contact.hpp"

/// @file The part of a body near its contact, solved directly.
///
/// On the dofs P of some layers of nodes around contact points, the rest R of the body held where it is, a stage is
///   A_PP c = (b − A x)_P + Hᵀ r̂,   x_P ← x_P + c,   with the contact conditions on x + c:
/// a stage of its own, small enough for a factor. One step of Schwarz's alternating method; the other is conjugate
/// gradients on the whole body with the reactions held. Inertia makes the influence of R on the contact decay within
/// the distance that a wave goes in a time step, so a few rounds are enough.
namespace ricochet {

class ContactZone {
 public:
  /// Around the nodes that the traces of these contact points reach. `matrix` is A on all dofs, `solved` tells per dof
  /// whether the stage solves for it. Keeps references to the problem only.
  ContactZone(const SemidiscreteProblem& problem, const SparseMatrix& matrix, const std::vector<char>& solved,
              const std::vector<Index>& points, int layers, bool all_candidates);

  /// With the residual b − A x of the whole body, reactions left out: x_P and the reactions.
  void solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution);
  /// The point is one that the zone was made for.
  [[nodiscard]] bool has(Index point) const { return has_[static_cast<std::size_t>(point)] != 0; }

  void report() const { contact_->report(); }
  void observe(const ContactObserver& observer) { contact_->observe(observer); }
  [[nodiscard]] double contact_seconds() const { return contact_->solver_seconds(); }
  [[nodiscard]] std::size_t factor_entries() const { return factor_.factor_entries(); }
  [[nodiscard]] std::size_t dof_count() const { return dof_at_.size(); }

 private:
  void choose_dofs(const SparseMatrix& matrix, const std::vector<char>& solved, const std::vector<Index>& points,
                   int layers, std::vector<int>& dofs) const;
  void state_locally(const Stage& stage, const Vector& x);

  const SemidiscreteProblem& problem_;
  std::vector<char> has_;    ///< per contact point
  std::vector<int> dof_at_;  ///< per place in the factor
  SparseCholesky factor_;
  std::unique_ptr<CondensedContact> contact_;
  Stage stage_;  ///< on the correction c, of the points of the zone
  Vector correction_, at_start_, factor_vector_;
};

}  // namespace ricochet
