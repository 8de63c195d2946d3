#pragma once

#include <string>
#include <vector>

#include "ricochet/rigid/obstacle.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/deepest_point.hpp"

/// @file Nodes that go through an obstacle within one step, so that neither end of the step shows it.
namespace ricochet {

/// Looks at nodes against obstacles whose normals are not the same everywhere. Seen from the obstacle a node goes
/// straight from one place to the other; it has gone through where it was inside between them, and the normals at the
/// ends are more than a right angle apart. (A node that slides round an edge goes through less of a chord.) As a gap
/// changes by no more than the node moves, most nodes are not looked at in most steps.
class PassageWatch {
 public:
  enum class Of { nodes, contact_points };
  /// Keeps a reference to the problem. `nodes`: ascending, or contact points.
  PassageWatch(const SemidiscreteProblem& problem, std::vector<Index> nodes,
               const std::vector<const Obstacle*>& obstacles, Of of = Of::nodes);
  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// Allocates nothing after the first time.
  void look(const State& state);
  /// Whether a node goes through between the last look and this state at a time: nothing is remembered of it.
  [[nodiscard]] bool any_passes(const State& state, double time) const;
  /// Of each obstacle, with the depth that it went through.
  [[nodiscard]] const std::vector<DeepestPoint>& passages() const { return passages_; }

 private:
  /// Of the nodes before: where they are seen from the obstacle, and no more than their gaps.
  struct Seen {
    Points places;
    Vector gaps;
  };
  void look_at(std::size_t obstacle, const State& state);
  [[nodiscard]] SpaceVector place_of(Index node, const State& state) const;

  const SemidiscreteProblem& problem_;
  std::vector<Index> nodes_;
  Of of_;
  std::vector<const Obstacle*> obstacles_;
  std::vector<Seen> seen_;
  std::vector<DeepestPoint> passages_;
};

}  // namespace ricochet
