#pragma once

#include <vector>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Sizes of the facets of contacts between bodies, which limit the resolution of the contact.
namespace ricochet {

/// Longest distance between corners, over the facets of a group around each node of the mesh.
struct FacetSizes {
  std::vector<double> smallest, largest;  ///< per node; 0 if no facet of the group contains it
};
[[nodiscard]] FacetSizes facet_sizes(const Body& body, const std::vector<Index>& facets);

/// Node at which a contact keeps its body out of another one, in the mean over facets.
struct ContactNodeAllowance {
  Index node = 0;
  int other = 0;           ///< the other body
  int contact = 0;         ///< index of the ContactPair
  Index entry = 0;         ///< in ContactBoundary::nodes; −1 on the opposite side of a pair with large sliding
  double allowance = 0.0;  ///< admissible depth: half of the largest facet there
};
/// `body_of_node`: numbers of bodies.
[[nodiscard]] std::vector<ContactNodeAllowance> contact_node_allowances(const Body& body,
                                                                        const ContactBoundary& contact,
                                                                        const std::vector<ContactPair>& pairs,
                                                                        const std::vector<int>& body_of_node);

/// Half of the smallest facet, on either side, at each point between bodies; 0 at obstacles.
[[nodiscard]] Vector slip_limits(const Body& body, const ContactBoundary& contact,
                                 const std::vector<ContactPair>& pairs);

}  // namespace ricochet
