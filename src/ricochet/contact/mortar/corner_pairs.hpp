#pragma once

#include <optional>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/fem/assembly.hpp"

/// @file Corners of the surface without multipliers.
///
/// Contact points are means over facets of the side with the multipliers: a sharp corner of the other side may sink in
/// between them, by a part of a facet. In the plane its corners therefore become contact points of their own, of a
/// second pair with exchanged sides. Their gaps are larger than those of the corners by an allowance, a fraction of a
/// facet, so that the first pair alone presses where the surfaces fit each other.
namespace ricochet {

/// Nodes at which two facets of a surface in the plane meet at a convex edge, with an angle of more than 30 degrees
/// between their normals.
[[nodiscard]] std::vector<Index> convex_corners(const Body& body, const std::vector<Index>& facets);

/// Pair of the corners of the opposite surface of a pair; none if that has none, or if the pair does not slide far.
[[nodiscard]] std::optional<ContactPair> corner_pair(const Body& body, const ContactPair& pair);

/// Allowance of corners, in lengths of the facets around them.
inline constexpr double corner_allowance = 0.05;

}  // namespace ricochet
