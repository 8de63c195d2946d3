#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/contact/turning_normal.hpp"

/// @file Contact between bodies that turn. The pairing of the start is kept (body_contact.hpp), and directions turn
/// with both surfaces: with y = Σ_j t_ij (X + U)_j, the mean vector across the gap, and N of turning_normal.hpp,
///   n(U) = N/|N|,   g(U) = n·y + (g₀ − n₀·y₀),
/// the constant being zero but for gaps that the input says to be others. No rigid motion of both bodies changes g, so
/// rows G = ∂g/∂U have neither resultant nor moment about the current positions, where facets have slid and where they
/// have not: beside t ⊗ n they have a part on the nodes of N that takes back the moment y × n r_N.
///
/// Rows of a step from U₀ to U₁ = U₀ + Δ, with ȳ and n̄ the means of both ends, ℓ̄ that of |N|, x the middle of the
/// step and N̄ that of N,
///   G = n̄ ⊗ t + ∂N(x)ᵀ w,   w = (ȳ − N̄ (n̄·ȳ)/ℓ̄)/ℓ̄,
/// are such that G Δ = g₁ − g₀, exactly: ∂N(x) Δ = N₁ − N₀, as N is quadratic. Normal forces then work nothing but
/// −r_N g₀ over a step at whose end they act on a closed gap, which is what no creation of energy rests on. They have
/// no resultant.
///
/// Where contact nodes have another middle of the step than ½(U₀ + U₁), forces r = r_N n(x) − τ r_T at that place x are
/// those of t ⊗ r with a couple ∂N(x)ᵀ w on the nodes of N instead, N × w = −y × r: no moment about x is left but the
/// part of y × r along N, that of friction across what has slid, which in two dimensions there is none of.
namespace ricochet {

struct TurningPairsData {
  struct Point {
    Index number = 0;  ///< among all contact points
    TurningNormal normal;
    double offset = 0.0;            ///< g₀ − n₀·y₀
    std::array<bool, 3> is_free{};  ///< components that no support holds
    std::vector<Index> nodes = {};  ///< those of its row of G, ascending
  };
  struct Node {
    Index entry = 0;  ///< of the contact boundary's nodes
    Index node = 0;
    TurningNormal normal;
    double offset = 0.0;
  };
  std::vector<Point> points;
  std::vector<Node> nodes;         ///< by ascending entry; those that face the other body
  Points node_positions;           ///< of all nodes, reference
  Points node_normals;             ///< of the contact boundary's nodes, at the start
  SparseRowMatrix trace;           ///< t
  SparseRowMatrix opposite_place;  ///< contact nodes × nodes
};

/// Rows of B_T have entries for every node of the trace; those of G for every node of TurningPairsData::Point::nodes.
[[nodiscard]] std::unique_ptr<ContactGeometry> make_turning_pairs(TurningPairsData data);

}  // namespace ricochet
