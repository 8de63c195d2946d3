#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/mortar/surface_segments.hpp"

/// @file The two surfaces of a contact between bodies, and the projection of nodes of one onto the other.
namespace ricochet {

/// Weight per node.
using NodeWeights = std::vector<std::pair<Index, double>>;

/// Sums as fractions of the weight, ascending by nodes; values that vanish to rounding are set to exact zero.
[[nodiscard]] NodeWeights fractions(const std::map<Index, double>& sums, double weight);

/// Removes from the area vector at a node on the axis of an axisymmetric body the component that the mirror image
/// cancels, and leaves the axial one. Does nothing at other nodes.
void remove_radial_part(const Body& body, Index node, Eigen::Vector3d& vector);

/// Facets (numbered through all blocks) around each node of the displacement.
using FacetsAround = std::map<Index, std::vector<Index>>;
[[nodiscard]] FacetsAround facets_around_nodes(const DisplacementSpace& space, const std::vector<Index>& facets);

/// Sum over the facets around a node of area vectors, out of the body, and of their lengths.
struct AreaSum {
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  double size = 0.0;
};
/// Area sums by nodes of the displacement; on an axis including the mirror image. `only`:
/// facets to include; all if null.
[[nodiscard]] std::map<Index, AreaSum> areas_around_nodes(const Body& body, const FacetSurface& surface,
                                                          const std::set<Index>* only = nullptr);

/// Both surfaces; `own` carries the multipliers and is displaced by ContactPair::pair_at.
struct PairedSurfaces {
  const Body& body;
  const FacetMap map;
  const FacetSurface own, opposite;
  const SegmentFinder finder, back;  ///< from the own surface to the opposite one, and back

  /// Keeps a reference to the body.
  PairedSurfaces(const Body& of_body, const ContactPair& pair);
  PairedSurfaces(const PairedSurfaces&) = delete;  // finders refer to the surfaces
  PairedSurfaces& operator=(const PairedSurfaces&) = delete;

  /// Position of a node without any shift; the third component is 0 in 2D.
  [[nodiscard]] Eigen::Vector3d position(Index node) const;
  /// Projects a node of one side onto the other one along a direction (unit, out of the other one).
  [[nodiscard]] BodyContact::Node node_facing(Index node, bool is_own, const Eigen::Vector3d& direction) const;
};

}  // namespace ricochet
