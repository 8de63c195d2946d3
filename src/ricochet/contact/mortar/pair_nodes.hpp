#pragma once

#include "ricochet/contact/mortar/pair_integration.hpp"
#include "ricochet/contact/mortar/paired_surfaces.hpp"

/// @file Nodal output of a contact between bodies: gaps on both sides, and the pressure on the opposite one.
namespace ricochet {

/// Area vectors around the nodes of the opposite facets that some own facet faces.
[[nodiscard]] std::map<Index, AreaSum> areas_around_faced_nodes(const PairedSurfaces& surfaces,
                                                                const std::vector<FacetSegments>& direct);

/// Nodes in the rows of the points of a contact, own ones, then those of the other side, ascending, each with its gap
/// along the direction of its multiplier, or, without one, against the mean normal of the facets around it that face
/// the other side. `direct`: the segments of each own facet along its own normal; `directions`: by nodes, empty if
/// multipliers have other anchors.
[[nodiscard]] std::vector<BodyContact::Node> nodes_of_points(const PairedSurfaces& surfaces,
                                                             const std::vector<FacetSegments>& direct,
                                                             const AnchorDirections& directions,
                                                             const BodyContact& contact);

/// Pressure recovery at the nodes of the opposite side: entries (node, number of the multiplier, value). Pressures at
/// own vertices come from the space; those at opposite vertices are means of them (PressureTransfer), and those at
/// nodes between vertices are the means of these.
[[nodiscard]] std::vector<Eigen::Triplet<double>> opposite_pressure(const PairedSurfaces& surfaces,
                                                                    const std::vector<FacetSegments>& direct,
                                                                    const MultiplierSpace& space,
                                                                    const std::vector<Multiplier>& multipliers);

}  // namespace ricochet
