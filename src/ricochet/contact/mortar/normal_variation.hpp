#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Variation of the normals of two surfaces within a facet, where the surfaces can come into contact.
namespace ricochet {

/// Means over all locations at which two bodies can come into contact by translation: there the normals of their
/// surfaces are opposite. A facet of one surface touches the other one where the other's normals include the
/// opposite of its own; the facets of both surfaces are weighted by their areas. A concave part is touched by
/// parts that are at least as convex.
///
/// With the curvatures κ of both surfaces there and the size h of a facet of the surface that carries the multipliers,
/// the variation is the angle h (κ_own + 2 κ_opposite). Gaps are means over its facets, and become inaccurate if the
/// surfaces bend away from each other; forces have the normals of the opposite surface, which should not vary within
/// one facet. Facets without curvature of their own are resolved at the size of their counterparts: on a mesh of first
/// order h is the larger of both sizes in the second term. The factor 2 is measured (docs/sliding.md): a flat surface
/// against a round one needs facets of half the size.
struct NormalVariation {
  bool touch = false;                ///< false if no normal of either surface is opposite to one of the other
  double own = 0.0, opposite = 0.0;  ///< variation, in rad, if that surface carries the multipliers
  /// Variations where at least one surface bends. Edges, of more than 45 degrees, are excluded.
  double own_of_bends = 0.0, opposite_of_bends = 0.0;
};

/// `facets`, `opposite_facets`: numbered through all blocks, ascending.
[[nodiscard]] NormalVariation normal_variation(const Body& body, const std::vector<Index>& facets,
                                               const std::vector<Index>& opposite_facets);

}  // namespace ricochet
