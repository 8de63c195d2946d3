#pragma once

#include <string>
#include <vector>

#include "ricochet/contact/obstacle.hpp"
#include "ricochet/fem/assembly.hpp"

/// @file The contact boundary and its trace operators.
///
/// Signs, once and for all. The source writes U·N_i ≤ 0 for contact at zero gap, with N_i the normal out of the body,
/// and multipliers ≤ 0. Here:
///   gap operator       G = −B_N: row i is the obstacle's outward normal at the dofs of contact node i;
///   gap                g = g₀ + G U, ≥ 0 when open;
///   normal reaction    r_N ≥ 0 in compression, a force (per length out of the plane in 2D);
///   force on the body  Gᵀ r_N − B_Tᵀ r_T, with r_T aligned with the slip rate.
/// Back to the source: λ̃_N^i = −r_N,i and U·N_i = −(g_i − g₀,i) where the obstacle's normal is −N_i.
namespace ricochet {

/// One boundary group against one obstacle, as a case asks for it.
struct ContactPair {
  std::string group;
  std::vector<Index> facets;  ///< numbered through all blocks
  std::string obstacle_name;
  const Obstacle* obstacle = nullptr;
  double friction_coefficient = 0.0;
};

/// Nodal contact: each node of the contact boundary is a contact point (once per obstacle that may touch it).
struct ContactBoundary {
  int dimension = 2;
  std::vector<Index> nodes;      ///< per point: its node
  std::vector<int> pair;         ///< per point: index of the ContactPair it came from (the first that names it)
  Points normals;                ///< per point: unit normal out of the obstacle, d × points
  std::vector<Points> tangents;  ///< per point: d × (d−1), orthonormal with the normal
  Vector initial_gap;            ///< g₀
  Vector gap_rounding;           ///< a gap up to this is zero to rounding
  Vector weights;                ///< ∫ φ_i over the boundary: length in 2D, area in 3D
  Vector friction_coefficient;
  SparseRowMatrix gap_operator;       ///< G, points × dofs
  SparseRowMatrix tangential_trace;   ///< B_T, (d−1)·points × dofs
  SparseRowMatrix pressure_recovery;  ///< pressure = this · r_N, see recovery rule below

  [[nodiscard]] Index size() const { return static_cast<Index>(nodes.size()); }
  /// The nodes that carry at least one point, ascending, each once.
  [[nodiscard]] std::vector<Index> unique_nodes() const;
};

/// Builds the boundary. Points that `keep` refuses (given the node and the unit normal) are left out: nodes whose
/// normal displacement is prescribed. Throws Error(invalid_input) when more conditions meet at a node than it has
/// components.
///
/// Pressure from nodal forces. On degree 1: p_i = r_i / ∫φ_i. On degree 2 vertex weights are smaller than those of the
/// middles and vanish on flat triangles, so forces are first gathered on the linear hat functions ψ_a of the vertices:
/// p_a = Σ_j ψ_a(x_j) r_j / ∫ψ_a, and a middle node takes the mean of the vertices of its edge or face. This is exact
/// for a uniform pressure, keeps the sign, and Σ_a p_a ∫ψ_a is the total force.
[[nodiscard]] ContactBoundary make_contact_boundary(const Body& body, const std::vector<ContactPair>& pairs,
                                                    const std::function<bool(Index node, const Vector& normal)>& keep);

}  // namespace ricochet
