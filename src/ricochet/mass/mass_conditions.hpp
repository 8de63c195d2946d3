#pragma once

#include <string>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Conditions on the equivalent mass of each body: total mass, centre of gravity and moments of inertia. Each
/// body is treated separately, in its own frame, so that thin bodies and the choice of units make no difference.
namespace ricochet {

/// Connected component of the graph of a matrix.
struct MassBody {
  std::vector<Index> nodes;  ///< in the order of traversal
  Vector centre;             ///< of gravity
  Matrix axes;               ///< x = centre + axes ξ, lower triangular
};

/// Bodies of a mesh, and (1, ξ, η[, ζ]) at each node. In the frame of its body
///   Σ_ij M_ij = m,   Σ_ij M_ij ξ_i = 0,   Σ_ij M_ij ξ_i ξ_jᵀ = m I.
/// An affine map of the body only rotates its ξ: decisions based on them are the same for flat and for compact bodies.
struct MassFrames {
  std::vector<MassBody> bodies;
  Matrix monomials;  ///< (d+1) × nodes
};
[[nodiscard]] MassFrames mass_frames(const SparseMatrix& mass, const Points& nodes);

/// Moments PᵀmP of one body, P = (1, ξ, η[, ζ]).
[[nodiscard]] Matrix mass_moments(const SparseMatrix& mass, const MassFrames& frames, const MassBody& body);

/// Largest difference between the moments of two masses in a body, relative to the largest moment; infinite
/// if the moments of `target` are zero.
[[nodiscard]] double moment_defect(const SparseMatrix& found, const SparseMatrix& target, const MassFrames& frames,
                                   const MassBody& body);
struct MassInput;
/// Throws Error(invalid_input) if the moments of a body differ from those of `input` by more than rounding: that of the
/// extrapolation weights, and that of the positions of the nodes, which matters more for thin bodies.
void check_moments(const MassInput& input, const SparseMatrix& mass, const std::string& type);
/// Lower estimate of the largest eigenvalue of D⁻¹M, to about one per cent: the amplification of the inertia of nodes.
[[nodiscard]] double top_eigenvalue(const SparseMatrix& mass, const Vector& diagonal);

/// "(1, 2, 3)"
[[nodiscard]] std::string text_of_point(const Points& nodes, Index node);
/// Describes a degenerate set of points of a body: "at one point", "on one line", "in one plane", or "" if they span
/// space, with a tolerance of 1e-6 of their extent, in the frame in which the body is equally wide in all directions.
/// The body itself may therefore be flat, but not the set of points: weights that extrapolate from points that do not
/// span space have Σ|w| near 1e6 and preserve no moment.
[[nodiscard]] std::string degeneracy(const Points& nodes, const std::vector<Index>& body,
                                     const std::vector<Index>& points);
[[nodiscard]] bool span_space(const Points& nodes, const std::vector<Index>& body, const std::vector<Index>& points);
/// Describes massive nodes, e.g. "3 nodes off the contact boundary, at (0, 0), (1, 0) and (2, 0), all on one line":
/// their number, the locations of the first ones, and their degeneracy.
[[nodiscard]] std::string describe_massive_nodes(const Points& nodes, const std::vector<Index>& body,
                                                 const std::vector<Index>& points);

}  // namespace ricochet
