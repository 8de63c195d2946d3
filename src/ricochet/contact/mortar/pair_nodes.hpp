#pragma once

#include "ricochet/contact/mortar/pair_integration.hpp"
#include "ricochet/contact/mortar/paired_surfaces.hpp"

/// @file What a contact between bodies says node by node: gaps on both sides, and the pressure on the opposite one.
namespace ricochet {

/// Around the nodes of the opposite facets that some own facet faces.
[[nodiscard]] std::map<Index, AreaSum> areas_around_faced_nodes(const PairedSurfaces& surfaces,
                                                                const std::vector<FacetSegments>& direct);

/// The nodes that the points of a contact reach, own ones, then those of the other side, ascending, each with the gap
/// that is seen from it: along the direction of its multiplier, or against the mean normal of the facets around it
/// that face the other side where it has none. `direct`: the segments of each own facet along its own normal;
/// `directions`: by nodes, empty where multipliers have other anchors.
[[nodiscard]] std::vector<BodyContact::Node> nodes_of_points(const PairedSurfaces& surfaces,
                                                             const std::vector<FacetSegments>& direct,
                                                             const AnchorDirections& directions,
                                                             const BodyContact& contact);

/// Pressure at the nodes of the opposite side: entries (node, number of the multiplier, value). Pressures of own
/// vertices come from the space; those of opposite vertices are means of them (PressureTransfer), and those of nodes
/// between vertices are the means of these.
[[nodiscard]] std::vector<Eigen::Triplet<double>> opposite_pressure(const PairedSurfaces& surfaces,
                                                                    const std::vector<FacetSegments>& direct,
                                                                    const MultiplierSpace& space,
                                                                    const std::vector<Multiplier>& multipliers);

}  // namespace ricochet
