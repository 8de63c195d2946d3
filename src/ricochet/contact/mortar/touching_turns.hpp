#pragma once

#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file How far the normals of two surfaces turn within a facet, where the surfaces can touch.
namespace ricochet {

/// Means over all places where two bodies can touch that move without turning: there the normals of their surfaces are
/// opposite. A facet of one surface touches the other one where the other's normals pass the opposite of its own; the
/// facets of both surfaces count by their areas. A hollow is touched by what bulges at least as much.
///
/// With the curvatures κ of both surfaces there and the size h of a facet of the surface that carries the multipliers,
/// its turn is h (κ_own + 2 κ_opposite). Gaps are means over its facets, which surfaces that bend away spoil; forces
/// have the normals of the opposite surface, which should not vary within one of its facets. Facets without curvature
/// of their own show the size of their neighbours: on a mesh of first order h is the larger of both sizes in the second
/// term. The factor 2 is measured (docs/sliding.md): a flat surface against a round one needs facets of half the size.
struct TouchingTurns {
  bool touch = false;                ///< false: nowhere on either surface is the opposite of a normal of the other one
  double own = 0.0, opposite = 0.0;  ///< turn of either surface, in rad, if it carries the multipliers
  /// Turns where at least one surface bends. Edges, of more than 45 degrees, are left out.
  double own_of_bends = 0.0, opposite_of_bends = 0.0;
};

/// `facets`, `opposite_facets`: numbered through all blocks, ascending.
[[nodiscard]] TouchingTurns touching_turns(const Body& body, const std::vector<Index>& facets,
                                           const std::vector<Index>& opposite_facets);

}  // namespace ricochet
