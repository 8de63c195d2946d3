#pragma once

#include <optional>
#include <string>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Selection of the surface that carries the multipliers of a contact.
namespace ricochet {

struct SideChoice {
  bool opposite = false;  ///< whether it is the second group of the pair
  std::string reason;     ///< "its mesh is finer (0.1 against 0.25)"
};

/// Selects the side with the smaller variation of normals within its facets (normal_variation.hpp): gaps are means over
/// facets, and forces of surfaces that slide far have the normals of the other side, so that a round side carries the
/// multipliers against a flat one, unless its facets are twice as large. If the variations are alike, and for tied
/// surfaces, it selects the side with the finer mesh: the number of conditions then matches the resolution of the
/// pressure, and each node of the coarser side is subject to several. For meshes that are alike (to a tenth), it
/// selects the more curved side, whose normals determine the location of contact better; then the softer one, then the
/// first group. Only the facets' sizes, curvatures and stiffnesses matter: unless surfaces are alike in all respects,
/// the choice depends neither on numbers of nodes nor on the order of the groups. For surfaces that slide far and have
/// alike variations, the smaller surface (by half, unless its mesh is three times as coarse) has priority: it slides on
/// the other one and over it, and its facets are covered completely except where it overhangs an end.
[[nodiscard]] SideChoice choose_side(const Body& body, const ContactPair& pair);

/// Doubt about the side that carries the multipliers, `pair.facets`: the mean variation of normals within its facets
/// where surfaces bend, and its value with the multipliers on the other side. Empty if there is no doubt.
struct SideDoubt {
  double variation = 0.0, other_variation = 0.0;  ///< rad
  bool other_is_better = false;
  double finer = 1.0;  ///< refinement factor of the facets of the better side that resolves the doubt
};
[[nodiscard]] std::optional<SideDoubt> doubt_side(const Body& body, const ContactPair& pair);

/// Mean distance h²/8R of straight facets from the curved surface that they approximate: of the side with the larger
/// value; 0 on a mesh of second order.
[[nodiscard]] double distance_from_curved(const Body& body, const ContactPair& pair);

}  // namespace ricochet
