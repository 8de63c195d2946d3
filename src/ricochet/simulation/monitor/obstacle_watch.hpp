#pragma once

#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/deepest_point.hpp"

/// @file The boundary that no contact keeps out of the obstacles.
namespace ricochet {

/// A contact whose group ends where it touches.
struct RimContact {
  int pair = 0;     ///< index of the ContactPair
  Index node = -1;  ///< on the rim
  double time = 0.0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
};

/// Looks at the nodes of the boundary against each obstacle, but for those that are contact nodes of it (their gaps are
/// in the history), and at the rims of the contact groups: facets of the boundary that have nodes of both kinds.
/// Contact goes on beyond a rim where a contact node on it is pressed and the rest of such a facet is as good as on the
/// obstacle: seen from that node it rises by less than a quarter. (The side of a block that rests on its base is such a
/// facet, too; it rises steeply.)
class ObstacleWatch {
 public:
  /// `obstacles`: all of the case; `size`: of the body that a node belongs to, per node.
  ObstacleWatch(const SemidiscreteProblem& problem, const std::vector<CellBlock>& cells,
                const std::vector<CellFacet>& boundary, const std::vector<const Obstacle*>& obstacles,
                const std::vector<double>& size);
  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// Allocates nothing.
  void look(const State& state);
  /// All nodes but those of contacts: a body whose boundary lies on that of its obstacle may be inside all the same.
  void look_at_start(const State& state);

  /// The deepest point of the boundary in each obstacle.
  [[nodiscard]] const std::vector<DeepestPoint>& deepest() const { return deepest_; }
  /// The first of each pair.
  [[nodiscard]] const std::vector<RimContact>& rims() const { return rims_; }

 private:
  /// A facet of the boundary at a rim.
  struct RimFacet {
    std::size_t obstacle = 0;
    std::vector<Index> inside;   ///< contact nodes, as entries of problem.contact.nodes
    std::vector<Index> outside;  ///< nodes of the body
  };
  void find_nodes(const std::vector<CellBlock>& cells, const std::vector<CellFacet>& boundary, std::size_t obstacle);
  [[nodiscard]] bool is_held_by_supports(std::size_t obstacle, Index node) const;
  /// Sets position_.
  [[nodiscard]] double gap(std::size_t obstacle, Index node, const Vector& displacement);
  void look_at_node(std::size_t obstacle, Index node, const State& state);
  void look_at_rim(const RimFacet& facet, const State& state);
  [[nodiscard]] bool is_pressed(std::size_t obstacle, Index contact_node, const State& state);
  [[nodiscard]] bool has_told(int pair) const;

  const SemidiscreteProblem& problem_;
  std::vector<const Obstacle*> obstacles_;
  std::vector<double> size_;
  std::vector<std::vector<Index>> nodes_;  ///< per obstacle
  std::vector<RimFacet> rim_;
  std::vector<DeepestPoint> deepest_;
  std::vector<RimContact> rims_;
  std::vector<PlacedObstacle> placed_;  ///< each obstacle at this time
  Vector position_;
};

}  // namespace ricochet
