#pragma once

#include <string>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Which of two surfaces carries the multipliers of their contact.
namespace ricochet {

struct SideChoice {
  bool opposite = false;  ///< the other group than the pair's first one
  std::string reason;     ///< "its mesh is finer (0.1 against 0.25)"
};

/// The side with the finer mesh: there are then as many conditions as there are places where pressures may differ, and
/// each node of the coarser side is held by several. Of meshes that are alike (to a tenth), the more curved side, whose
/// normals say more of where bodies touch; then the softer one, then the first group. Of facets' sizes, curvatures and
/// stiffnesses alone: it does not depend on numbers of nodes or on which group is named first, but for surfaces that
/// are alike in all. Where bodies slide far, the smaller surface (by half, unless its mesh is three times as coarse):
/// it slides on the other one and over it, and its facets are covered as a whole but where it hangs over an end.
[[nodiscard]] SideChoice choose_side(const Body& body, const ContactPair& pair);

/// How far straight facets are from the curved surface that they stand for, h²/8R in the mean: of the side where it is
/// more; 0 on a mesh of second order.
[[nodiscard]] double distance_from_curved(const Body& body, const ContactPair& pair);

}  // namespace ricochet
