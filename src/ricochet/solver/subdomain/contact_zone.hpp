#pragma once

#include <vector>

#include "ricochet/solver/delassus/factored_stage.hpp"
#include "ricochet/solver/stage/stage_product.hpp"

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
  struct Extent {
    std::vector<Index> nodes;       ///< ascending
    std::vector<Index> own_nodes;   ///< those that this zone moves, where there are others
    std::vector<Index> points;      ///< whose conditions hold in the zone
    std::vector<Index> own_points;  ///< those whose reactions are kept
  };
  /// `solved` tells per dof whether the stage solves for it. Keeps a reference to the problem only.
  ContactZone(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
              const std::vector<char>& solved, const Extent& extent, const StageProduct& product, bool all_candidates,
              FactoredStage* layer);

  /// `stage` is one on the correction c; what is eligible in it is chosen here. `correction`, per dof of the problem:
  /// work space, zero before and after. x moves where it is the zone's own; `solution` is that of the zone.
  void solve(Stage& stage, const std::vector<char>& eligible, const Vector& residual, Vector& correction, Vector& x,
             StageSolution& solution);
  /// Of a solution of the zone what is its own.
  void keep_own(const StageSolution& local, StageSolution& solution) const;

  /// What the contact conditions leave for later stages.
  void save(Snapshot& snapshot, const std::string& name) const { zone_->save(snapshot, name); }
  void load(const Snapshot& snapshot, const std::string& name) { zone_->load(snapshot, name); }
  void report() const { zone_->report(); }
  void observe(const ContactObserver& observer) { zone_->observe(observer); }
  [[nodiscard]] double contact_seconds() const { return zone_->contact_seconds(); }
  [[nodiscard]] std::size_t factor_entries() const { return zone_->factor_entries(); }

 private:
  std::vector<char> has_;  ///< per contact point
  std::vector<Index> own_points_;
  std::vector<int> own_dofs_;
  std::unique_ptr<FactoredStage> zone_;
};

}  // namespace ricochet
