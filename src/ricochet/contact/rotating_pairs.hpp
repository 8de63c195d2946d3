#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/contact/rotating_normal.hpp"

/// @file Contact between bodies with large rotations. The initial pairing is kept (body_contact.hpp), and directions
/// rotate with both surfaces: with y = Σ_j t_ij (X + U)_j, the mean vector across the gap, and N of
/// rotating_normal.hpp,
///   n(U) = N/|N|,   g(U) = n·y + (g₀ − n₀·y₀),
/// where the constant is zero unless the input modifies gaps. No rigid motion of both bodies changes g, so that rows G
/// = ∂g/∂U have no resultant and no moment about the current positions, whether or not facets have slid: in addition to
/// t ⊗ n they have terms on the nodes of N that cancel the moment y × n r_N.
///
/// Rows of a step from U₀ to U₁ = U₀ + Δ, with ȳ and n̄ the means over both ends, ℓ̄ that of |N|, x the middle of the
/// step and N̄ the mean of N,
///   G = n̄ ⊗ t + ∂N(x)ᵀ w,   w = (ȳ − N̄ (n̄·ȳ)/ℓ̄)/ℓ̄,
/// satisfy G Δ = g₁ − g₀ exactly: ∂N(x) Δ = N₁ − N₀, since N is quadratic. The work of normal forces over
/// a step that ends with a closed gap is then only −r_N g₀, the basis of the proof that no energy is
/// created. They have no resultant.
///
/// If contact nodes have another middle of the step than ½(U₀ + U₁), the forces r = r_N n(x) − τ r_T at those positions
/// x are instead those of t ⊗ r with a couple ∂N(x)ᵀ w on the nodes of N, N × w = −y × r: the only remaining moment
/// about x is the component of y × r along N, that of friction over the distance slid, which vanishes in 2D.
namespace ricochet {

struct RotatingPairsData {
  struct Point {
    Index number = 0;  ///< among all contact points
    RotatingNormal normal;
    double offset = 0.0;            ///< g₀ − n₀·y₀
    std::array<bool, 3> is_free{};  ///< components without support
    std::vector<Index> nodes = {};  ///< of its row of G, ascending
  };
  struct Node {
    Index entry = 0;  ///< in the contact boundary's nodes
    Index node = 0;
    RotatingNormal normal;
    double offset = 0.0;
  };
  std::vector<Point> points;
  std::vector<Node> nodes;              ///< ascending by entry; only those that face the other body
  Points node_positions;                ///< reference positions of all nodes
  Points node_normals;                  ///< of the contact boundary's nodes, at the start
  SparseRowMatrix trace;                ///< t
  SparseRowMatrix opposite_projection;  ///< contact nodes × nodes
};

/// Rows of B_T have entries for every node of the trace; those of G for every node of RotatingPairsData::Point::nodes.
[[nodiscard]] std::unique_ptr<ContactGeometry> make_rotating_pairs(RotatingPairsData data);

}  // namespace ricochet
