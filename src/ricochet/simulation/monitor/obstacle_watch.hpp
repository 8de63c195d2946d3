#pragma once

#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/deepest_point.hpp"

/// @file Penetration of obstacles by the part of the boundary without contact.
namespace ricochet {

/// Contact whose group ends within the contact area.
struct RimContact {
  int pair = 0;     ///< index of the ContactPair
  Index node = -1;  ///< on the border of the group
  double time = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();

  [[nodiscard]] auto members() { return std::tie(pair, node, time, position); }
};

/// Checks the nodes of the boundary against each obstacle, except for the contact nodes of that obstacle (whose gaps
/// are in the history), and the borders of the contact groups: boundary facets that have nodes of both kinds. Contact
/// continues beyond a border if a contact node on it is pressed and the rest of such a facet practically lies on the
/// obstacle: seen from that node its slope is less than a quarter. (The side of a block that rests on its base is such
/// a facet, too, but it is steep.)
class ObstacleWatch {
 public:
  /// `obstacles`: all of the case; `size`: per node, of the body to which it belongs.
  ObstacleWatch(const SemidiscreteProblem& problem, const std::vector<CellBlock>& cells,
                const std::vector<CellFacet>& boundary, const std::vector<const Obstacle*>& obstacles,
                const std::vector<double>& size);
  void persist(const SnapshotVisitor& visit);

  /// Checks a state. Allocates nothing.
  void check(const State& state);
  /// Checks all nodes except those of contacts: even a body whose boundary coincides with that of its obstacle may be
  /// inside.
  void check_start(const State& state);

  /// Deepest point of the boundary in each obstacle.
  [[nodiscard]] const std::vector<DeepestPoint>& deepest() const { return deepest_; }
  /// First border contact of each pair.
  [[nodiscard]] const std::vector<RimContact>& rims() const { return rims_; }

 private:
  /// Moves the obstacles to their positions in this state, as a static start may move rigid bodies.
  void pose_obstacles(const State& state);
  /// Boundary facet at the border of a contact group.
  struct RimFacet {
    std::size_t obstacle = 0;
    std::vector<Index> inside;   ///< contact nodes, as indices into problem.contact.nodes
    std::vector<Index> outside;  ///< nodes of the body
  };
  void find_nodes(const std::vector<CellBlock>& cells, const std::vector<CellFacet>& boundary, std::size_t obstacle);
  [[nodiscard]] bool is_supported(std::size_t obstacle, Index node) const;
  /// Returns the gap of a node; sets position_.
  [[nodiscard]] double gap(std::size_t obstacle, Index node, const Vector& displacement);
  void check_node(std::size_t obstacle, Index node, const State& state);
  void check_rim(const RimFacet& facet, const State& state);
  [[nodiscard]] bool is_pressed(std::size_t obstacle, Index contact_node, const State& state);
  [[nodiscard]] bool is_warned(int pair) const;

  const SemidiscreteProblem& problem_;
  std::vector<const Obstacle*> obstacles_;
  std::vector<double> size_;
  std::vector<std::vector<Index>> nodes_;  ///< per obstacle
  std::vector<RimFacet> rim_;
  std::vector<DeepestPoint> deepest_;
  std::vector<RimContact> rims_;
  std::vector<PosedObstacle> posed_;  ///< each obstacle at the current time
  Vector position_;
};

}  // namespace ricochet
