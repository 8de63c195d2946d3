#pragma once

#include <array>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Directions of a contact point: along which the body can be pushed off and along which it can slip, given what
/// supports hold there.
namespace ricochet {

/// Whether a node can move along the unit normal: false where supports hold every component of it.
[[nodiscard]] bool has_free_part(Index node, const Vector& normal, const FreeComponent& is_free);

struct ContactTangents {
  Points directions;            ///< d × (d−1), orthonormal with the normal
  std::array<bool, 2> slips{};  ///< per direction: whether there is friction along it
};

/// A node that no support holds slips along all tangents. One held component in 3D leaves one direction of slip,
/// n × e_a, which comes first. With fewer free components than that, a motion along a tangent is not independent of one
/// along the normal: no friction acts.
[[nodiscard]] ContactTangents tangents_at(Index node, const Vector& normal, const FreeComponent& is_free);

/// The directions of a point whose rows follow the motion: its normal, tangents and the values of its rows of B_T,
/// which have entries for every node of the trace. `is_free`: components that no support holds.
void write_directions(Index point, const SpaceVector& normal, const std::array<bool, 3>& is_free,
                      const SparseRowMatrix& trace, ContactRows& rows);

}  // namespace ricochet
