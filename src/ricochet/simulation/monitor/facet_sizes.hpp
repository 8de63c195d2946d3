#pragma once

#include <vector>

#include "ricochet/contact/contact_boundary.hpp"

/// @file How large the facets of contacts between bodies are: what such a contact resolves.
namespace ricochet {

/// Of the facets of a group around each node of the mesh: the longest distance between their corners.
struct FacetSizes {
  std::vector<double> smallest, largest;  ///< per node; 0 where no facet of the group is
};
[[nodiscard]] FacetSizes facet_sizes(const Body& body, const std::vector<Index>& facets);

/// A node at which a contact keeps its body out of another one, in the mean over facets.
struct KeptNode {
  Index node = 0;
  int other = 0;           ///< that body
  int contact = 0;         ///< index of the ContactPair
  Index entry = 0;         ///< in ContactBoundary::nodes; −1: it is not there, as the far side of a pair that slides
  double allowance = 0.0;  ///< how deep it may be inside: half of the largest facet there
};
/// `body_of_node`: numbers of bodies.
[[nodiscard]] std::vector<KeptNode> kept_nodes(const Body& body, const ContactBoundary& contact,
                                               const std::vector<ContactPair>& pairs,
                                               const std::vector<int>& body_of_node);

/// Half of the smallest facet that a point between bodies sees, on either side, per point; 0 at obstacles.
[[nodiscard]] Vector slip_limits(const Body& body, const ContactBoundary& contact,
                                 const std::vector<ContactPair>& pairs);

}  // namespace ricochet
