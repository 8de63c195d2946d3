#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Contact between bodies with unlimited sliding (sliding_pair.hpp).
///
/// Rows of an instant are the derivatives of the gaps there. Rows of a step from U₀ to U₁ = U₀ + Δ are those of its
/// middle, corrected to the actual change of the gap along the non-rigid part Δ̃ of the motion of their nodes (the
/// remainder after removing the linear rigid motion about their positions x in the middle, by least squares):
///   G = ∂g(x) + (g₁ − g₀ − ∂g(x)Δ) Δ̃ᵀ/|Δ̃|².
/// Hence G Δ = g₁ − g₀ (a discrete gradient: O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449–467), and G has no
/// resultant and no moment about x, since ∂g has none and Δ̃ is orthogonal to all rigid motions. A correction that
/// decreases the product G Δ is always made: normal forces on a gap that ends closed then do at most the work −r_N
/// g₀, and create no energy. One that increases it is limited to a fraction of the row; the deficit is the work of a
/// change of pairing, which dissipates energy. Points that face nothing at the start of the step have the rows of
/// its end, and no positive product.
///
/// Slips are those of the material points that face each other in the middle of the step, perpendicular to the force. A
/// point that faces nothing has the row of a plane perpendicular to its normal, and a gap that no motion closes.
namespace ricochet {

struct SlidingContactData {
  struct Node {
    Index entry = 0;  ///< in the contact boundary's nodes
    Index node = 0;
    std::size_t pair = 0;
    RotatingNormal normal;
  };
  std::vector<std::unique_ptr<SlidingPair>> pairs;
  std::vector<Node> nodes;  ///< of own surfaces, ascending by entry
  Points node_positions;    ///< reference positions of all nodes
  Points node_normals;      ///< of the contact boundary's nodes, at the start
  double unpaired_gap = 0;  ///< the gap of a point that faces nothing
};

[[nodiscard]] std::unique_ptr<ContactGeometry> make_sliding_contact(SlidingContactData data);

}  // namespace ricochet
