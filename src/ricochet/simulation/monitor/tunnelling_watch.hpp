#pragma once

#include <vector>

#include "ricochet/rigid/obstacle.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/deepest_point.hpp"

/// @file Tunnelling: nodes that pass through an obstacle within one step, so that neither end of the step shows it.
namespace ricochet {

/// Checks nodes against obstacles whose normal varies. Relative to the obstacle a node moves straight from one position
/// to the next; it has passed through if it was inside between them and the normals at the ends differ by more than a
/// right angle. (A node that slides round an edge passes through less of a chord.) As a gap changes by no more than the
/// node moves, most nodes need not be evaluated in most steps.
class TunnellingWatch {
 public:
  enum class Of { nodes, contact_points };
  /// Keeps a reference to the problem. `nodes`: ascending, or contact points.
  TunnellingWatch(const SemidiscreteProblem& problem, std::vector<Index> nodes,
                  const std::vector<const Obstacle*>& obstacles, Of of = Of::nodes);
  void persist(const SnapshotVisitor& visit);

  /// Checks a state after the previous one. Allocates nothing after the first time.
  void check(const State& state);
  /// Returns whether a node passes through between the last checked state and this one at a time, without recording it.
  [[nodiscard]] bool any_tunnels(const State& state, double time) const;
  /// First passage through each obstacle, with its depth.
  [[nodiscard]] const std::vector<DeepestPoint>& passages() const { return passages_; }

 private:
  /// Previous state of the nodes: positions in the frame of the obstacle, and lower bounds of their gaps.
  struct Previous {
    Points positions;
    Vector gaps;
  };
  void check_obstacle(std::size_t obstacle, const State& state);
  [[nodiscard]] SpaceVector position_of(Index node, const State& state) const;

  const SemidiscreteProblem& problem_;
  std::vector<Index> nodes_;
  Of of_;
  std::vector<const Obstacle*> obstacles_;
  std::vector<Previous> previous_;
  std::vector<DeepestPoint> passages_;
};

}  // namespace ricochet
