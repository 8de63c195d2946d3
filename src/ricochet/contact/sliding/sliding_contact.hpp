#pragma once

#include <memory>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/contact/sliding/sliding_pair.hpp"

/// @file Contact between bodies that slide along each other without limit (sliding_pair.hpp).
///
/// Rows of an instant are the derivatives of the gaps there. Rows of a step from U₀ to U₁ = U₀ + Δ are those of its
/// middle, with what they lack of the gap's change along that part Δ̃ of the motion of their nodes which is no rigid one
/// (of the linear motions about their places x in the middle, by least squares):
///   G = ∂g(x) + (g₁ − g₀ − ∂g(x)Δ) Δ̃ᵀ/|Δ̃|².
/// So G Δ = g₁ − g₀ (a discrete gradient: O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449–467), and G has neither resultant
/// nor moment about x, as ∂g has none and Δ̃ is perpendicular to all rigid motions. A correction that takes from the
/// product is made in any case: normal forces on a gap that ends closed then work −r_N g₀ at most, and give no energy.
/// One that adds to it is made up to a part of the row; what is then missing is the work of a re-pairing, which takes
/// some. Points that face nothing where the step begins have the rows of its end, and no positive product.
///
/// Slips are those of the material points that face each other in the middle of the step, perpendicular to the force's
/// direction. A point that faces nothing has the row of a plane across its normal, and a gap that no motion closes.
namespace ricochet {

struct SlidingContactData {
  struct Node {
    Index entry = 0;  ///< of the contact boundary's nodes
    Index node = 0;
    std::size_t pair = 0;
    TurningNormal normal;
  };
  std::vector<std::unique_ptr<SlidingPair>> pairs;
  std::vector<Node> nodes;  ///< of own surfaces, by ascending entry
  Points node_positions;    ///< of all nodes, reference
  Points node_normals;      ///< of the contact boundary's nodes, at the start
  double out_of_sight = 0;  ///< the gap of a point that faces nothing
};

[[nodiscard]] std::unique_ptr<ContactGeometry> make_sliding_contact(SlidingContactData data);

}  // namespace ricochet
