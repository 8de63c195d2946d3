#pragma once

#include <vector>

#include "ricochet/solver/delassus/factored_stage.hpp"
#include "ricochet/solver/stage/stage_product.hpp"

/// @file Subdomain: part of a body near its contact, solved directly.
///
/// On the dofs P of some layers of nodes around contact points, with the rest R of the body fixed, a stage is
///   A_PP c = (b − A x)_P + Hᵀ r̂,   x_P ← x_P + c,   with the contact conditions on x + c:
/// a stage of its own, small enough for a factor. This is one step of Schwarz's alternating method; the other is
/// conjugate gradients on the whole body with the reactions fixed. Inertia makes the influence of R on the contact
/// decay within the distance of a wave in a time step, so a few iterations suffice.
namespace ricochet {

class Subdomain {
 public:
  struct Extent {
    std::vector<Index> nodes;       ///< ascending
    std::vector<Index> own_nodes;   ///< those moved by this subdomain, if there are others
    std::vector<Index> points;      ///< whose conditions hold in the subdomain
    std::vector<Index> own_points;  ///< those whose reactions are kept
  };
  /// `solved`, per dof: the stage solves for it. Keeps a reference to the problem only.
  Subdomain(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
            const std::vector<char>& solved, const Extent& extent, const StageProduct& product, bool all_candidates,
            FactoredStage* condensed_stage);

  /// Restricts eligible points to those of the subdomain.
  void choose_points(const std::vector<char>& eligible, std::vector<char>& own) const;
  /// Solves for the correction c. `stage` is one on c, with the points of choose_points(). `correction`, per dof of the
  /// problem, is work space, zero before and after. x changes on the subdomain's own nodes; `solution` is that of the
  /// subdomain.
  void solve(const LinearStage& stage, const Vector& residual, Vector& correction, Vector& x, StageSolution& solution);
  /// Restricts a subdomain solution to the points it owns.
  void restrict_to_own(const StageSolution& local, StageSolution& solution) const;

  /// Saves and loads the data that the contact conditions leave for later stages.
  void persist(const SnapshotVisitor& visit) { stage_->persist(visit); }
  void report() const { stage_->report(); }
  void observe(const ContactObserver& observer) { stage_->observe(observer); }
  [[nodiscard]] double contact_seconds() const { return stage_->contact_seconds(); }
  [[nodiscard]] std::size_t factor_entries() const { return stage_->factor_entries(); }

 private:
  std::vector<char> has_;  ///< per contact point: it is in the subdomain
  std::vector<Index> own_points_;
  std::vector<int> own_dofs_;
  std::unique_ptr<FactoredStage> stage_;
};

}  // namespace ricochet
