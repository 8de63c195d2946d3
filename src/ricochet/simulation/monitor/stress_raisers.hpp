#pragma once

#include <span>
#include <string>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/fem/boundary_ridges.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/peak_stress_result.hpp"

/// @file Singularities of linear elasticity, where the stress is infinite, so that the largest one of a mesh grows with
/// its refinement and does not characterize the body.
///
/// - Re-entrant edges, of more than 180° inside the body (M. L. Williams, J. Appl. Mech. 19 (1952) 526–528).
/// - Ends of supports: between a held face and a free one from about 60° on. A support along the normal alone
///   represents a mirror image of the body: it ends in twice the angle, 180° at the border of a plane of symmetry.
///   Likewise a support of all tangential components.
/// - Sharp edges of a body or an obstacle that are pressed against another surface (a punch). A face that lies without
///   friction on an obstacle up to its edge is mirrored by it and has no singularity.
/// Ends of tied surfaces and of interfaces between materials are not considered.
namespace ricochet {

/// Description such as "a re-entrant edge of the body"; empty for none.
[[nodiscard]] std::string name_of(StressRaiser raiser);

class StressRaisers {
 public:
  /// Keeps references. On a divided body, ridges between the parts are not considered.
  StressRaisers(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs,
                const BodiesOfMesh& bodies);

  /// Returns the cause of a raised stress in a cell in this state.
  [[nodiscard]] StressRaiser at(const State& state, Index cell);

 private:
  enum class SupportKind : char { free, mirror, fixed };

  using Nodes = std::span<const Index>;

  [[nodiscard]] unsigned supported_components(Nodes nodes) const;
  [[nodiscard]] SupportKind support_of(unsigned components, const Eigen::Vector3d& normal) const;
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
    bool is_open_ended;         ///< of two bodies, or with friction: no mirror image continues beyond it
    std::vector<Index> beside;  ///< nodes of the adjacent contact facets
  };
  std::vector<unsigned> facet_supported_;   ///< per facet: components that supports hold at all nodes
  std::vector<char> facet_touches_;         ///< per facet: all nodes belong to contact facets
  std::vector<StressRaiser> of_node_;       ///< per node: raiser there or at a neighbour, in any state
  std::vector<ContactEdge> contact_edges_;  ///< ascending
  std::vector<char> touching_;              ///< per node: 1 in contact facets, 2 also in open-ended ones
  std::vector<char> pressed_;               ///< per node
};

}  // namespace ricochet
