#pragma once

#include <string>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file What an equivalent mass promises of each body: total mass, centre of gravity and moments of inertia. Bodies
/// are looked at one by one, each in a frame of its own, so that neither thin bodies nor units make a difference.
namespace ricochet {

/// A connected component of a matrix's graph.
struct MassBody {
  std::vector<Index> nodes;  ///< in the order in which they are reached
  Vector centre;             ///< of gravity
  Matrix axes;               ///< x = centre + axes ξ, lower triangular
};

/// The bodies of a mesh, and (1, ξ, η[, ζ]) at each node. In the frame of its body
///   Σ_ij M_ij = m,   Σ_ij M_ij ξ_i = 0,   Σ_ij M_ij ξ_i ξ_jᵀ = m I.
/// An affine map of the body only turns its ξ: whatever is decided by them is decided alike for flat and for round
/// bodies.
struct MassFrames {
  std::vector<MassBody> bodies;
  Matrix monomials;  ///< (d+1) × nodes
};
[[nodiscard]] MassFrames mass_frames(const SparseMatrix& mass, const Points& nodes);

/// PᵀmP of one body, P = (1, ξ, η[, ζ]).
[[nodiscard]] Matrix mass_moments(const SparseMatrix& mass, const MassFrames& frames, const MassBody& body);

/// The largest difference of two masses' moments in a body, relative to the largest; infinite where none is wanted.
[[nodiscard]] double moment_defect(const SparseMatrix& found, const SparseMatrix& wanted, const MassFrames& frames,
                                   const MassBody& body);
struct MassInput;
/// Throws Error(invalid_input) where the moments of a body are not those of `input`, rounding apart: that of the
/// weights which extrapolate, and that of the nodes' positions, which counts more the thinner the body is.
void check_moments(const MassInput& input, const SparseMatrix& mass, const std::string& type);
/// The largest eigenvalue of D⁻¹M, from below, to a per cent or so: how much inertia piles up where there was D.
[[nodiscard]] double top_eigenvalue(const SparseMatrix& mass, const Vector& diagonal);

/// "(1, 2, 3)"
[[nodiscard]] std::string text_of_point(const Points& nodes, Index node);
/// How points of a body lie: "at one point", "on one line", "in one plane", or "" where they span space, to 1e-6 of
/// what they extend, in the frame in which the body is as wide in all directions. So it is not the body that may be
/// flat, but the points in it: weights that extrapolate from points which do not span space have Σ|w| near 1e6, and
/// keep no moment.
[[nodiscard]] std::string degeneracy(const Points& nodes, const std::vector<Index>& body,
                                     const std::vector<Index>& points);
[[nodiscard]] bool span_space(const Points& nodes, const std::vector<Index>& body, const std::vector<Index>& points);
/// "3 nodes off the contact boundary, at (0, 0), (1, 0) and (2, 0), all on one line": how many there are, where the
/// first ones are, and how they lie.
[[nodiscard]] std::string describe_free_nodes(const Points& nodes, const std::vector<Index>& body,
                                              const std::vector<Index>& points);

}  // namespace ricochet
