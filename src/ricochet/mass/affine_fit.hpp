#pragma once

#include "ricochet/base/types.hpp"

/// @file Best affine fits to values at some nodes. In the frame of the nodes, in which their centre of gravity is the
/// origin and their second moments are the identity,
///   Σ_j t_j ξ_j = 0,   Σ_j t_j ξ_j ξ_jᵀ = t I,   t = Σ_j t_j,
/// the affine function with the least Σ_j t_j (f(ξ_j) − v_j)² is Σ_j w_j(ξ) v_j with
///   w_j(ξ) = (t_j/t) (1 + ξ_j·ξ).
/// These are also the weights that reproduce affine functions at ξ with the least Σ w_j²/t_j, which is (1 + |ξ|²)/t.
/// An affine map of the nodes rotates ξ and leaves w unchanged: flat cells are treated as well as equilateral ones.
namespace ricochet {

struct AffineFrame {
  double base[3] = {}, offset[3] = {};  ///< the centre of gravity is base + offset; base is a node
  double axes[3][3] = {};               ///< x = base + offset + axes ξ, lower triangular
  double total_weight = 0.0;            ///< t
  /// Inverse of Σ_j (t_j/t) p_j p_jᵀ, p = (1, ξ), which is the identity up to rounding: with it the weights reproduce
  /// the positions of the nodes to rounding of the positions, however flat the cells are.
  double inverse_gram[4][4] = {};
};

/// Returns false if the nodes, up to rounding, do not span space affinely: collinear in 2D; coplanar or collinear in
/// 3D. `node_weights` has one value per node of the mesh.
[[nodiscard]] bool make_affine_frame(const Points& nodes, const int* of, int count, const Vector& node_weights,
                                     AffineFrame& frame);
/// Computes ξ of a point.
void affine_coordinates(const AffineFrame& frame, int dimension, const double* point, double* xi);
/// Computes the weight of a node of the frame, with its t_j: Σ_j weight_j v_j are the value of the fit at the centre
/// and its gradient in ξ, and weight · (1, ξ) is w_j(ξ).
void affine_weight(const AffineFrame& frame, int dimension, const double* point, double node_weight,
                   double (&weight)[4]);
/// Computes the change of coordinates ξ = shift + linear η, with η the coordinates in frame `from`.
void affine_change(const AffineFrame& from, const AffineFrame& to, int dimension, double (&shift)[3],
                   double (&linear)[3][3]);

}  // namespace ricochet
