#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/body_contact.hpp"
#include "ricochet/contact/boundary_nodes.hpp"
#include "ricochet/fem/tied_nodes.hpp"

/// @file What a contact boundary is put together from. Not part of the public interface.
namespace ricochet {

/// The pairs that share an obstacle and a space of multipliers, or one pair of bodies, with the multipliers in use.
struct BoundaryPatch {
  const Obstacle* obstacle = nullptr;  ///< null: a pair of bodies
  std::string multipliers;
  ContactPatch facets;
  std::unique_ptr<MultiplierSpace> space;
  std::vector<Multiplier> kept;
  std::vector<PointConditions> conditions;  ///< of each
  /// Of each: its trace, on nodes that are not tied.
  std::vector<TiedNodes::Weights> free_traces;
  std::vector<int> numbers;              ///< of the kept multipliers among all contact points
  std::vector<BodyContact::Node> nodes;  ///< of a pair of bodies: those of both sides
  std::vector<Index> reached;            ///< nodes that traces reach, tied ones, too
  /// Pressures at the nodes of the group, and of the other side: entries (node, kept multiplier, value).
  std::vector<Eigen::Triplet<double>> recovery, opposite_recovery;

  [[nodiscard]] int first_pair() const { return facets.parts.front().pair; }
  /// Obstacles whose gap is a linear function of the position, and bodies: rows do not change.
  [[nodiscard]] bool is_flat() const { return obstacle == nullptr || obstacle->is_flat(); }
};

/// Each with its multipliers, conditions and numbers, which are by node (a facet counts as its first one), then by
/// pair. The patches keep references to `nodes`. `facings`: of pairs of bodies, by number of the pair.
[[nodiscard]] std::vector<std::unique_ptr<BoundaryPatch>> make_patches(const Body& body,
                                                                       const std::vector<ContactPair>& pairs,
                                                                       const BoundaryNodes& nodes,
                                                                       const FreeComponent& is_free,
                                                                       std::vector<PairFacing>& facings);

/// Normals and gaps of the kept multipliers of a patch at an obstacle.
void take_obstacle_conditions(const Body& body, BoundaryPatch& patch);

/// The nodes that traces reach, and what is reported at them.
void fill_boundary_nodes(const std::vector<std::unique_ptr<BoundaryPatch>>& patches, const BoundaryNodes& all,
                         const Body& body, const std::vector<ContactPair>& pairs, ContactBoundary& boundary);

}  // namespace ricochet
