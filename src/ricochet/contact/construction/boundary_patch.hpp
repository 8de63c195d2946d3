#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/construction/boundary_nodes.hpp"
#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/rotating_normal.hpp"
#include "ricochet/fem/tied_nodes.hpp"

/// @file Parts from which a contact boundary is assembled. Not part of the public interface.
namespace ricochet {

/// Pairs that share an obstacle and a multiplier space, or one pair of bodies, with the multipliers in use.
struct BoundaryPatch {
  const Obstacle* obstacle = nullptr;  ///< null for a pair of bodies
  std::string multipliers;
  ContactPatch facets;
  std::unique_ptr<MultiplierSpace> space;
  std::vector<Multiplier> retained;
  std::vector<PointConditions> conditions;  ///< per retained multiplier
  /// Per retained multiplier: its trace on untied nodes.
  std::vector<TiedNodes::Weights> free_traces;
  std::vector<int> numbers;              ///< of the retained multipliers among all contact points
  std::vector<BodyContact::Node> nodes;  ///< of both sides of a pair of bodies
  bool slides = false;                   ///< whether it is a pair of bodies with unlimited sliding
  /// Per retained multiplier its direction, between bodies of finite strain, and between those that slide.
  std::vector<RotatingNormal> rotating_normals;
  std::vector<Index> reached;  ///< nodes in the traces, including tied ones
  /// Pressure recovery at the nodes of the group, and of the other side: entries (node, retained multiplier, value).
  std::vector<Eigen::Triplet<double>> recovery, opposite_recovery;

  [[nodiscard]] int first_pair() const { return facets.parts.front().pair; }
  /// Whether rows follow the motion: at obstacles whose gap is a nonlinear function of the position, and
  /// between bodies of finite strain.
  [[nodiscard]] bool follows_motion() const {
    return obstacle != nullptr ? !obstacle->has_constant_normals() : !rotating_normals.empty();
  }
};

/// Creates all patches with their multipliers, conditions and numbers, which are ordered by node (the first node of a
/// facet), then by pair. The patches keep references to `nodes`. `facings`: for pairs of bodies, by number of the pair.
[[nodiscard]] std::vector<std::unique_ptr<BoundaryPatch>> make_patches(const Body& body,
                                                                       const std::vector<ContactPair>& pairs,
                                                                       const BoundaryNodes& nodes,
                                                                       const FreeComponent& is_free,
                                                                       std::vector<PairingSummary>& facings);

/// Computes normals and gaps of the retained multipliers of a patch at an obstacle.
void compute_obstacle_conditions(const Body& body, BoundaryPatch& patch);

/// Creates the multipliers of a pair of bodies with unlimited sliding. Throws Error(invalid_input) if
/// facets fold, or nodes are tied.
void make_sliding_patch(const Body& body, const ContactPair& pair, const FreeComponent& is_free, BoundaryPatch& patch,
                        PairingSummary& facing);

/// Creates the geometry of sliding pairs; null if there are none. Marks their points in the boundary.
[[nodiscard]] std::unique_ptr<ContactGeometry> make_sliding_geometry(
    const Body& body, const std::vector<ContactPair>& pairs, const std::vector<std::unique_ptr<BoundaryPatch>>& patches,
    const FreeComponent& is_free, ContactBoundary& boundary);

/// Finds the directions of the retained multipliers between bodies of finite strain, from the facets around them whose
/// vertices are untied contact nodes: own ones, or, if there are none, those of the other side. Multipliers without
/// such facets, and those on an axis, keep their initial direction; the number of the former is logged.
void find_rotating_normals(const Body& body, const std::vector<ContactPair>& pairs,
                           const std::vector<std::unique_ptr<BoundaryPatch>>& patches);

/// Creates the geometry of these patches whose directions rotate with the bodies; null if there are none.
[[nodiscard]] std::unique_ptr<ContactGeometry> make_rotating_geometry(
    const Body& body, const std::vector<ContactPair>& pairs, const std::vector<std::unique_ptr<BoundaryPatch>>& patches,
    const FreeComponent& is_free, const ContactBoundary& boundary);

/// Node whose supports determine along which tangents there is friction; between bodies it may be on either side.
[[nodiscard]] Index freest_node(const BoundaryPatch& patch, std::size_t index, int dimension,
                                const FreeComponent& is_free);

/// Fills in the nodes of the traces, and their nodal output.
void fill_boundary_nodes(const std::vector<std::unique_ptr<BoundaryPatch>>& patches, const BoundaryNodes& all,
                         const Body& body, const std::vector<ContactPair>& pairs, ContactBoundary& boundary);

}  // namespace ricochet
