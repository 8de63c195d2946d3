#pragma once

#include <array>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Directions of a contact point: those along which the body can separate and those along which it
/// can slip, given its supports.
namespace ricochet {

/// Whether a node can move along the unit normal; false if supports constrain all its components.
[[nodiscard]] bool has_free_part(Index node, const Vector& normal, const FreeComponent& is_free);

struct ContactTangents {
  Points directions;            ///< d × (d−1), orthonormal with the normal
  std::array<bool, 2> slips{};  ///< per direction: whether friction acts along it
};

/// Returns the tangents at a node. An unsupported node slips along all of them. One constrained component in 3D leaves
/// one direction of slip, n × e_a, which comes first. With fewer free components, a motion along a tangent is not
/// independent of one along the normal: no friction acts.
[[nodiscard]] ContactTangents tangents_at(Index node, const Vector& normal, const FreeComponent& is_free);

/// Writes the directions of a point whose rows follow the motion: its normal, tangents and the values of its rows of
/// B_T, which have entries for every node of the trace. `is_free`: components without support.
void write_directions(Index point, const SpaceVector& normal, const std::array<bool, 3>& is_free,
                      const SparseRowMatrix& trace, ContactRows& rows);

}  // namespace ricochet
