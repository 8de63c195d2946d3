#pragma once

#include <functional>

#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/fem/tied_nodes.hpp"

/// @file Two tied surfaces: the nodes of one are constrained to the other.
namespace ricochet {

struct TiedSurface {
  std::vector<TiedNodes::Tie> ties;
  PairingSummary facing;
  /// Largest distance between the surfaces at a tied node, relative to the height of the
  /// cell behind it, and its location.
  double farthest_in_heights = 0.0;
  Vector farthest_position;
};

/// With dual multipliers the mortar conditions C u_s = M̂ u_m are solved node by node where facets are
/// covered completely: P = C⁻¹M̂ has few entries per node, and reproduces linear functions on flat surfaces.
/// A node that does not face the other surface remains free. Throws Error(invalid_input) if facets fold
/// around a node, or P is meaningless. `stays_free`: nodes that are constrained otherwise, or must not be
/// constrained by this tie; null if none.
[[nodiscard]] TiedSurface tie_surfaces(const Body& body, const ContactPair& pair,
                                       const std::function<bool(Index)>& stays_free = nullptr);

/// Moves tied nodes to their projections Σ P X on the other surface: rotations of both together then cause no
/// strain (M. A. Puso, Int. J. Numer. Meth. Engng 59, 2004, 315–336). The nodes of the geometry move with those of
/// the displacement. Returns the largest distance of a tied node from its position in the geometry, relative to the
/// size of its facet: if it exceeds rounding (a curved surface, and a geometry of lower degree than the
/// displacement) rotations do cause strain.
[[nodiscard]] double move_tied_nodes(const TiedNodes& tied, Mesh& mesh, DisplacementSpace& space);

}  // namespace ricochet
