#pragma once

#include <memory>
#include <vector>

#include "ricochet/solver/delassus/factored_stage.hpp"
#include "ricochet/solver/stage/stage_product.hpp"
#include "ricochet/solver/subdomain/contact_neighbourhood.hpp"
#include "ricochet/solver/subdomain/contact_region.hpp"

/// @file Subdomains of a body near its contact, each solved directly, all from the same residual.
namespace ricochet {

/// Part of a body near its contact, solved directly.
///
/// On the dofs P of some layers of nodes around contact points, with the rest R of the body fixed, a stage is
///   A_PP c = (b − A x)_P + Hᵀ r̂,   x_P ← x_P + c,   with the contact conditions on x + c:
/// a stage of its own, small enough for a factor. This is one step of Schwarz's alternating method; the other is
/// conjugate gradients on the whole body with the reactions fixed. Inertia makes the influence of R on the contact
/// decay within the distance of a wave in a time step, so a few iterations suffice.
class Subdomain {
 public:
  struct Extent {
    std::vector<Index> nodes;       ///< ascending
    std::vector<Index> own_nodes;   ///< those moved by this subdomain, if there are others
    std::vector<Index> points;      ///< whose conditions hold in the subdomain
    std::vector<Index> own_points;  ///< those whose reactions are kept
  };
  /// `solved`, per dof: the stage solves for it. Keeps references to the problem and `shared`.
  Subdomain(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
            const std::vector<char>& solved, const Extent& extent, const StageProduct& product, SharedContact& shared,
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

 private:
  std::vector<char> has_;  ///< per contact point: it is in the subdomain
  std::vector<Index> own_points_;
  std::vector<int> own_dofs_;
  std::unique_ptr<FactoredStage> stage_;
};

/// A subdomain is a cluster of contact points with some layers of nodes around them, including the points of other
/// clusters that it contains. From its solution only the reactions of its own points are kept, and the motion of the
/// nodes that are nearer to its own points than to those of other subdomains: a restricted additive Schwarz method. All
/// nodes of a point are moved by its subdomain, so contact and friction hold to rounding. Many points then do not form
/// a large dense problem, and the cost of contact grows in proportion to their number.
class Subdomains final : public ContactRegion {
 public:
  /// Keeps references to the problem, the product, the graph and `shared`; `solved`, per dof: the stage solves for it.
  Subdomains(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
             const std::vector<char>& solved, const StageProduct& product, ContactNeighbourhood& neighbourhood,
             SharedContact& shared, FactoredStage* condensed_stage);

  void make(const std::vector<Index>& points) override {
    partition(points);
    make_share(0, 1);
  }
  /// Performs make() in two parts, if others make subdomains, too: returns their number, and makes every `count`-th one
  /// from `number` on.
  std::size_t partition(const std::vector<Index>& points);
  void make_share(std::size_t number, std::size_t count);
  void clear() override { subdomains_.clear(); }
  [[nodiscard]] bool are_made() const override { return !subdomains_.empty(); }
  [[nodiscard]] const std::vector<Index>& nodes() const override { return nodes_; }
  void solve(const LinearStage& stage, const Vector& residual, Vector& x, StageSolution& solution) override;
  void find_motion(const ContactRows& rows, const StageSolution& solution, const Vector& increment,
                   Vector& motion) override {
    massless_nodes_->find_motion(rows, solution, increment, motion);
  }

  /// Sets the number of layers of nodes around the points of a subdomain; 0: the number of cells that a wave crosses,
  /// computed with the next subdomains.
  void set_layers(int layers) { layers_ = layers; }
  [[nodiscard]] int layers() const { return layers_; }
  [[nodiscard]] std::size_t count() const { return subdomains_.size(); }

  void persist(const SnapshotVisitor& visit, const std::vector<Index>& points) override;
  /// Saves and loads the data of subdomains that are made.
  void persist_made(const SnapshotVisitor& visit);
  void report() const override;

 private:
  [[nodiscard]] std::vector<Subdomain::Extent> subdomains_of(const std::vector<Index>& points, std::size_t max_points);

  const SemidiscreteProblem& problem_;
  OperatorCoefficients coefficients_;
  const std::vector<char>& solved_;
  const StageProduct& product_;
  ContactNeighbourhood& neighbourhood_;
  SharedContact& shared_;
  FactoredStage* condensed_stage_;
  std::unique_ptr<MasslessContactNodes> massless_nodes_;  ///< null if the stage has no massless contact nodes
  int layers_ = 0;                                        ///< 0 if not known yet
  std::vector<Index> nodes_;                              ///< of all subdomains
  std::vector<Subdomain::Extent> extents_;                ///< of all subdomains, until they are made
  bool is_one_ = false;                                   ///< there is no other subdomain, here or elsewhere
  std::vector<std::unique_ptr<Subdomain>> subdomains_;
  ContactConditions conditions_;       ///< of the stage on the correction
  RightHandSide supports_at_rest_;     ///< likewise; the force is the residual
  Vector correction_, motion_, slip_;  ///< correction; G x and B_T x at the start
  StageSolution solution_;             ///< of one subdomain
};

}  // namespace ricochet
