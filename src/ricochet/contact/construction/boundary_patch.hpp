#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/construction/boundary_nodes.hpp"
#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/turning_normal.hpp"
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
  bool slides = false;                   ///< between bodies that slide without limit
  /// Between bodies of finite strain, and between those that slide, of each: its direction.
  std::vector<TurningNormal> turning;
  std::vector<Index> reached;  ///< nodes that traces reach, tied ones, too
  /// Pressures at the nodes of the group, and of the other side: entries (node, kept multiplier, value).
  std::vector<Eigen::Triplet<double>> recovery, opposite_recovery;

  [[nodiscard]] int first_pair() const { return facets.parts.front().pair; }
  /// At obstacles whose gap is no linear function of the position, and between bodies of finite strain.
  [[nodiscard]] bool follows_motion() const {
    return obstacle != nullptr ? !obstacle->has_constant_normals() : !turning.empty();
  }
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

/// The multipliers of a pair of bodies that slide without limit. Throws Error(invalid_input) where facets fold, and at
/// tied nodes.
void make_sliding_patch(const Body& body, const ContactPair& pair, const FreeComponent& is_free, BoundaryPatch& patch,
                        PairFacing& facing);

/// What makes the rows of these follow the motion; null: there are none. Tells the boundary which points they are.
[[nodiscard]] std::unique_ptr<ContactGeometry> follow_sliding(
    const Body& body, const std::vector<ContactPair>& pairs, const std::vector<std::unique_ptr<BoundaryPatch>>& patches,
    const FreeComponent& is_free, ContactBoundary& boundary);

/// Between bodies of finite strain, the directions of the kept multipliers, by the facets around them whose vertices
/// are contact nodes and not tied: own ones, or where there are none those of the other side. Multipliers without such
/// facets, and those on an axis, keep the direction of the start; of the others that keep it the log says how many.
void find_turning_normals(const Body& body, const std::vector<ContactPair>& pairs,
                          const std::vector<std::unique_ptr<BoundaryPatch>>& patches);

/// What makes the rows of these patches follow the motion; null: nothing does.
[[nodiscard]] std::unique_ptr<ContactGeometry> turn_with_bodies(
    const Body& body, const std::vector<ContactPair>& pairs, const std::vector<std::unique_ptr<BoundaryPatch>>& patches,
    const FreeComponent& is_free, const ContactBoundary& boundary);

/// The node whose supports decide along which tangents there is friction; between bodies it may be of either.
[[nodiscard]] Index freest_node(const BoundaryPatch& patch, std::size_t kept, int dimension,
                                const FreeComponent& is_free);

/// The nodes that traces reach, and what is reported at them.
void fill_boundary_nodes(const std::vector<std::unique_ptr<BoundaryPatch>>& patches, const BoundaryNodes& all,
                         const Body& body, const std::vector<ContactPair>& pairs, ContactBoundary& boundary);

}  // namespace ricochet
