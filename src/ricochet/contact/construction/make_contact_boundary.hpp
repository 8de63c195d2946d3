#pragma once

#include <vector>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Construction of the contact boundary from the pairs of a case.
namespace ricochet {

struct PairingSummary;

/// Builds the boundary. Multipliers of nodes that supports constrain along the normal are omitted, and so are those of
/// facets whose nodes all are; `supported_nodes` (may be null) receives the number of such nodes, each once per
/// obstacle. Throws Error(invalid_input) if obstacles at a shared node coincide in one plane with different friction,
/// if pairs that share a node and an obstacle differ in multipliers or (except for "p0") in friction, if a multiplier
/// space is unknown, if a multiplier has no positive D_i, or if a nodal force has a negative one under Tresca's law.
/// `facings` (may be null) receives the pairing statistics of each pair of bodies, and nothing for obstacles. A pair of
/// bodies that do not face each other has no points.
[[nodiscard]] ContactBoundary make_contact_boundary(const Body& body, const std::vector<ContactPair>& pairs,
                                                    const FreeComponent& is_free, Index* supported_nodes = nullptr,
                                                    std::vector<PairingSummary>* facings = nullptr);

}  // namespace ricochet
