#pragma once

#include <vector>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Construction of the contact boundary from the pairs of a case.
namespace ricochet {

struct PairFacing;

/// Builds the boundary. Multipliers of nodes that supports hold along the normal are left out, and so are those of
/// facets all of whose nodes are; `held_nodes` (may be null) receives the number of such nodes, each once per obstacle.
/// Throws Error(invalid_input) when obstacles at a shared node are one plane of unlike friction, when pairs that share
/// a node and an obstacle differ in multipliers or (but for "p0") in friction, when a multiplier space is unknown, when
/// a multiplier has no positive D_i, or when a nodal force has a negative one under Tresca's law. `facings`
/// (may be null) receives how the groups of each pair face each other; nothing of pairs with obstacles. A pair of
/// bodies that do not face each other gets no points.
[[nodiscard]] ContactBoundary make_contact_boundary(const Body& body, const std::vector<ContactPair>& pairs,
                                                    const FreeComponent& is_free, Index* held_nodes = nullptr,
                                                    std::vector<PairFacing>* facings = nullptr);

}  // namespace ricochet
