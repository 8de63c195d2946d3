#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/mortar/surface_segments.hpp"

/// @file The two surfaces of a contact between bodies, and how nodes of either see the other one.
namespace ricochet {

/// Per node its weight.
using NodeWeights = std::vector<std::pair<Index, double>>;

/// Sums as fractions of the weight, ascending by nodes; what vanishes to rounding is an exact zero.
[[nodiscard]] NodeWeights fractions(const std::map<Index, double>& sums, double weight);

/// Of area vectors around a node on the axis of an axisymmetric body what is left with those beyond it: the part along
/// it. Nothing changes at other nodes.
void take_across_axis(const Body& body, Index node, Eigen::Vector3d& vector);

/// Of the facets (numbered through all blocks), by node of the displacement.
using FacetsAround = std::map<Index, std::vector<Index>>;
[[nodiscard]] FacetsAround facets_around_nodes(const DisplacementSpace& space, const std::vector<Index>& facets);

/// Of the facets around a node: the sum of area vectors, out of the body, and of their lengths.
struct AreaSum {
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  double size = 0.0;
};
/// By nodes of the displacement; on an axis with the mirror image beyond it. `only`: facets that count; null: all.
[[nodiscard]] std::map<Index, AreaSum> areas_around_nodes(const Body& body, const FacetSurface& surface,
                                                          const std::set<Index>* only = nullptr);

/// `own` carries the multipliers, displaced by ContactPair::pair_at.
struct PairedSurfaces {
  const Body& body;
  const FacetMap map;
  const FacetSurface own, opposite;
  const SegmentFinder finder, back;  ///< from the own surface to the opposite one, and from there to the own one

  /// Keeps a reference to the body.
  PairedSurfaces(const Body& of_body, const ContactPair& pair);
  PairedSurfaces(const PairedSurfaces&) = delete;  // finders refer to the surfaces
  PairedSurfaces& operator=(const PairedSurfaces&) = delete;

  /// Where a node is without any shift; the third coordinate is 0 in two dimensions.
  [[nodiscard]] Eigen::Vector3d position(Index node) const;
  /// What a node of one side sees of the other one along a direction (unit, out of the other one).
  [[nodiscard]] BodyContact::Node node_facing(Index node, bool is_own, const Eigen::Vector3d& direction) const;
};

}  // namespace ricochet
