#pragma once

#include <memory>
#include <vector>

#include "ricochet/linear_algebra/matrix_graph.hpp"
#include "ricochet/solver/contact_zone.hpp"
#include "ricochet/solver/stage_product.hpp"

/// @file The parts of a body near its contact, each solved directly, all from the same residual.
namespace ricochet {

/// A zone is a cluster of contact points with some layers of nodes around them, the points of other clusters that it
/// contains included. Of its solution only the reactions of its own points are kept, and the motion of the nodes that
/// are nearer to its own points than to those of other zones: a restricted additive Schwarz method. All nodes of a
/// point are moved by its zone, so contact and friction hold to rounding. Many points are then no large dense problem,
/// and the price of contact grows as their number.
class ContactZones {
 public:
  /// Keeps references to the problem and the product; `solved` tells per dof whether the stage solves for it.
  ContactZones(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
               const std::vector<char>& solved, const StageProduct& product, bool all_points, FactoredStage* layer);

  /// For these points, and no others.
  void make(const std::vector<Index>& points);
  void clear();
  [[nodiscard]] bool are_made() const { return !zones_.empty(); }
  /// Points with some node within a few layers of those of the given ones, and these: a contact that grows should not
  /// ask for other zones in every step. Ascending.
  [[nodiscard]] std::vector<Index> with_neighbours(const std::vector<Index>& points);

  /// With the residual b − A x of the whole body, reactions left out: x near the contact, and the reactions.
  void solve(const Stage& stage, const Vector& residual, Vector& x, StageSolution& solution);

  /// Of nodes around the points of a zone; 0 before any were made.
  [[nodiscard]] int layers() const { return layers_; }
  [[nodiscard]] std::size_t count() const { return zones_.size(); }

  void save(Snapshot& snapshot, const std::string& name) const;
  /// Zones for these points, as they were saved.
  void load(const Snapshot& snapshot, const std::string& name, const std::vector<Index>& points);
  void report() const;
  void observe(const ContactObserver& observer);
  [[nodiscard]] double contact_seconds() const;
  [[nodiscard]] std::size_t factor_entries() const;

 private:
  [[nodiscard]] const MatrixGraph& graph();
  [[nodiscard]] std::vector<ContactZone::Extent> divide(const std::vector<Index>& points, std::size_t most);
  [[nodiscard]] std::vector<Index> nodes_of(const std::vector<Index>& points) const;

  const SemidiscreteProblem& problem_;
  OperatorCoefficients coefficients_;
  const std::vector<char>& solved_;
  const StageProduct& product_;
  bool all_points_;
  FactoredStage* layer_;
  int layers_ = 0;     ///< 0: not known yet
  MatrixGraph graph_;  ///< of cells: an equivalent mass has neighbours farther away
  std::vector<std::unique_ptr<ContactZone>> zones_;
  ContactObserver observer_;
  double earlier_contact_seconds_ = 0.0;
  Stage stage_;                        ///< on the correction
  Vector correction_, motion_, slip_;  ///< and G x and B_T x of the start
  StageSolution solution_;             ///< of one zone
};

/// The cells that a pressure wave crosses in the step of A = αM + κK near these nodes, √(Σ κ K_ii / Σ α m_i) with the
/// sums m of the rows of M, over the dofs with inertia. On tetrahedra of degree 1 with α = 4/h², κ = 1 it is that
/// within a twentieth. Infinite without inertia.
[[nodiscard]] double cells_crossed(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                   const StageProduct& product, const std::vector<Index>& nodes);

}  // namespace ricochet
