#pragma once

#include <vector>

#include "ricochet/solver/factored_stage.hpp"

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
  /// On these nodes, for these contact points; `solved` tells per dof whether the stage solves for it. Keeps a
  /// reference to the problem only.
  ContactZone(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
              const std::vector<char>& solved, const std::vector<Index>& nodes, const std::vector<Index>& points,
              bool all_candidates, const Vector& displacement = {}, FactoredStage* layer = nullptr);

  /// With the residual b − A x of the whole body, reactions left out: x_P and the reactions.
  void solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution);

  /// What the contact conditions leave for later stages.
  void save(Snapshot& snapshot, const std::string& name) const { zone_->save(snapshot, name); }
  void load(const Snapshot& snapshot, const std::string& name) { zone_->load(snapshot, name); }
  void report() const { zone_->report(); }
  void observe(const ContactObserver& observer) { zone_->observe(observer); }
  [[nodiscard]] double contact_seconds() const { return zone_->contact_seconds(); }
  [[nodiscard]] std::size_t factor_entries() const { return zone_->factor_entries(); }

 private:
  void state_locally(const Stage& stage, const Vector& x);

  std::vector<char> has_;  ///< per contact point
  std::unique_ptr<FactoredStage> zone_;
  Stage stage_;                        ///< on the correction c, of the points of the zone
  Vector correction_, motion_, slip_;  ///< c, and G x and B_T x of the start
};

}  // namespace ricochet
