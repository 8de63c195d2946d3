#pragma once

#include <optional>
#include <string>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Which of two surfaces carries the multipliers of their contact.
namespace ricochet {

struct SideChoice {
  bool opposite = false;  ///< the other group than the pair's first one
  std::string reason;     ///< "its mesh is finer (0.1 against 0.25)"
};

/// The side within whose facets normals turn less (touching_turns.hpp): gaps are means over them, and forces of
/// surfaces that slide far have the normals of the other side, so that a round side carries the multipliers against a
/// flat one, unless its facets are twice as large. Where turns are alike, and of tied surfaces, the side with the finer
/// mesh: there are then as many conditions as there are places where pressures may differ, and each node of the coarser
/// side is held by several. Of meshes that are alike (to a tenth), the more curved side, whose normals say more of
/// where bodies touch; then the softer one, then the first group. Of facets' sizes, curvatures and stiffnesses alone:
/// it does not depend on numbers of nodes or on which group is named first, but for surfaces that are alike in all. Of
/// surfaces that slide far and have alike turns, the smaller surface (by half, unless its mesh is three times as
/// coarse) comes first: it slides on the other one and over it, and its facets are covered as a whole but where it
/// hangs over an end.
[[nodiscard]] SideChoice choose_side(const Body& body, const ContactPair& pair);

/// Doubt about the side that carries the multipliers, `pair.facets`: the mean turn within
/// its facets where surfaces bend, and what it would be with the multipliers on the other side. No doubt: empty.
struct SideDoubt {
  double turn = 0.0, of_other = 0.0;  ///< rad
  bool other_is_better = false;
  double finer = 1.0;  ///< factor on the facets of the better side with which the doubt ends
};
[[nodiscard]] std::optional<SideDoubt> doubt_side(const Body& body, const ContactPair& pair);

/// How far straight facets are from the curved surface that they stand for, h²/8R in the mean: of the side where it is
/// more; 0 on a mesh of second order.
[[nodiscard]] double distance_from_curved(const Body& body, const ContactPair& pair);

}  // namespace ricochet
