#pragma once

#include "ricochet/base/types.hpp"

/// @file Affine functions that fit values at some nodes best. In the frame of the nodes, in which their centre of
/// gravity is the origin and their second moments are one,
///   Σ_j t_j ξ_j = 0,   Σ_j t_j ξ_j ξ_jᵀ = t I,   t = Σ_j t_j,
/// the affine function of least Σ_j t_j (f(ξ_j) − v_j)² is Σ_j w_j(ξ) v_j with
///   w_j(ξ) = (t_j/t) (1 + ξ_j·ξ).
/// These are also the weights that reproduce affine functions at ξ with the least Σ w_j²/t_j, which is (1 + |ξ|²)/t.
/// An affine map of the nodes changes neither ξ, but for a rotation, nor w: flat cells are no worse than round ones.
namespace ricochet {

struct AffineFrame {
  double base[3] = {}, offset[3] = {};  ///< the centre of gravity is at base + offset, base a node
  double axes[3][3] = {};               ///< x = base + offset + axes ξ, lower triangular
  double trust = 0.0;                   ///< t
  /// The inverse of Σ_j (t_j/t) p_j p_jᵀ, p = (1, ξ), which is the identity but for rounding: with it weights reproduce
  /// the positions of nodes to rounding of these, however flat their cells are.
  double inverse_gram[4][4] = {};
};

/// False where the nodes do not span space affinely, rounding apart: on one line (2D), in one plane or fewer.
/// `trust` has a value per node of the mesh.
[[nodiscard]] bool make_affine_frame(const Points& nodes, const int* of, int count, const Vector& trust,
                                     AffineFrame& frame);
/// ξ of a point.
void affine_coordinates(const AffineFrame& frame, int dimension, const double* point, double* xi);
/// Of a node of the frame, with its t_j: Σ_j weight_j v_j are the value in the centre and the gradient in ξ of the fit,
/// weight · (1, ξ) is w_j(ξ).
void affine_weight(const AffineFrame& frame, int dimension, const double* point, double trust, double (&weight)[4]);
/// ξ = shift + turn η, for η in another frame.
void affine_change(const AffineFrame& from, const AffineFrame& to, int dimension, double (&shift)[3],
                   double (&turn)[3][3]);

}  // namespace ricochet
