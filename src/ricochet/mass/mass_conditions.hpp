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

/// The largest difference of two masses' moments in any body, relative to that body's largest; the body is `worst`.
[[nodiscard]] double moment_defect(const SparseMatrix& found, const SparseMatrix& wanted, const MassFrames& frames,
                                   const MassBody** worst = nullptr);

/// "(1, 2, 3)"
[[nodiscard]] std::string text_of_point(const Points& nodes, Index node);
/// How points lie: "at one point", "on one line", "in one plane", or "" where they span space, rounding apart.
[[nodiscard]] std::string degeneracy(const Points& nodes, const std::vector<Index>& points);
/// False where points of a body are in one plane (in 2D: on one line) or fewer, to 1e-6 of what they extend, in the
/// frame in which the body is as wide in all directions: weights that extrapolate from them to the body's nodes have
/// Σ|w| near 1e6, which keeps no moment.
[[nodiscard]] bool span_space(const Points& nodes, const std::vector<Index>& body, const std::vector<Index>& points);
/// "3 nodes off the contact boundary, at (0, 0), (1, 0) and (2, 0), all on one line": how many there are, where the
/// first ones are, and how they lie.
[[nodiscard]] std::string describe_free_nodes(const Points& nodes, const std::vector<Index>& points);

}  // namespace ricochet
