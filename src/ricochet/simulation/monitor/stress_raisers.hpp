#pragma once

#include <span>
#include <string>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/fem/boundary_ridges.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/peak_stress_result.hpp"

/// @file Where linear elasticity has a stress that is infinite, so that the largest one of a mesh grows with its
/// refinement and says nothing of the body.
///
/// - At a re-entrant edge, of more than 180° inside the body (M. L. Williams, J. Appl. Mech. 19 (1952) 526–528).
/// - Where a support ends: between a held face and a free one from some 60° on. A support along the normal alone stands
///   for a mirror image of the body: it ends in twice the angle, 180° at the border of a plane of symmetry. Likewise
///   one of all tangential components.
/// - At a sharp edge of a body or of an obstacle that is pressed against another surface (a punch). A face that lies
///   without friction on an obstacle up to its edge is as by a mirror, and has none.
/// Ends of tied surfaces and of interfaces between materials are not looked at.
namespace ricochet {

/// "a re-entrant edge of the body"; empty: none.
[[nodiscard]] std::string name_of(StressRaiser raiser);

class StressRaisers {
 public:
  /// Keeps references. Of a divided body, ridges between parts are not looked at.
  StressRaisers(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs,
                const BodiesOfMesh& bodies);

  /// Returns what raises the stress in a cell, in this state.
  [[nodiscard]] StressRaiser at(const State& state, Index cell);

 private:
  enum class Hold : char { free, mirror, fixed };

  using Nodes = std::span<const Index>;

  [[nodiscard]] unsigned held(Nodes nodes) const;
  [[nodiscard]] Hold hold_of(unsigned held, const Eigen::Vector3d& normal) const;
  void judge(const Ridge& ridge);
  void mark(const Ridge& ridge, StressRaiser raiser);
  void reach_neighbours();
  void find_pressed(const State& state);
  [[nodiscard]] bool presses_by_edge(const State& state, Nodes nodes, double size) const;
  [[nodiscard]] bool is_flush(const State& state, Index node, double size) const;
  [[nodiscard]] bool touches_sharp_obstacle(const State& state, Nodes nodes, double size) const;
  [[nodiscard]] SpaceVector position(const State& state, Index node) const;

  const Body& body_;
  const SemidiscreteProblem& problem_;
  const BodiesOfMesh& bodies_;
  struct ContactEdge {
    Index node;
    bool is_open_ended;         ///< of two bodies, or with friction: no mirror image goes on beyond it
    std::vector<Index> beside;  ///< nodes of the contact facets around it
  };
  std::vector<unsigned> facet_held_;        ///< components that supports hold at all nodes, per facet
  std::vector<char> facet_touches_;         ///< all nodes are of contact facets
  std::vector<StressRaiser> of_node_;       ///< there or beside it, whatever the state is
  std::vector<ContactEdge> contact_edges_;  ///< ascending
  std::vector<char> touching_;              ///< per node: 1 of contact facets, 2 also of open-ended ones
  std::vector<char> pressed_;               ///< per node
};

}  // namespace ricochet
