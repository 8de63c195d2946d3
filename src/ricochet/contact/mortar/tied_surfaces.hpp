#pragma once

#include <functional>

#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/fem/tied_nodes.hpp"

/// @file Two surfaces glued together: the nodes of one follow those of the other.
namespace ricochet {

struct TiedSurface {
  std::vector<TiedNodes::Tie> ties;
  PairFacing facing;
  /// The largest distance between the surfaces at a tied node, over the height of the cell behind it, and where.
  double farthest_in_heights = 0.0;
  Vector farthest_place;
};

/// With dual multipliers the mortar conditions C u_s = M̂ u_m are solved node by node where facets are covered whole:
/// P = C⁻¹M̂ has few entries per node, and reproduces linear functions on flat surfaces. A node that does not face the
/// other surface stays free. Throws Error(invalid_input) where facets fold around a node, or P has no sense.
/// `stays_free`: nodes that follow something else, or must not follow this; null: none.
[[nodiscard]] TiedSurface tie_surfaces(const Body& body, const ContactPair& pair,
                                       const std::function<bool(Index)>& stays_free = nullptr);

/// Moves tied nodes to where they are on the other surface, Σ P X: then turns of both together have no strain (M. A.
/// Puso, Int. J. Numer. Meth. Engng 59, 2004, 315–336). The nodes of the geometry go with those of the displacement.
/// Returns the largest distance of a tied node from the place of the geometry that it had, over the size of its facet:
/// beyond rounding (a curved surface, and a geometry of lower degree than the displacement) turns do have strain.
[[nodiscard]] double move_tied_nodes(const TiedNodes& tied, Mesh& mesh, DisplacementSpace& space);

}  // namespace ricochet
