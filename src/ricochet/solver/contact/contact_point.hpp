#pragma once

#include <Eigen/Core>
#include <limits>

#include "ricochet/base/types.hpp"

/// @file Contact and friction at one point: the law, its exact solution and its residuals.
namespace ricochet {

inline constexpr double machine_epsilon = std::numeric_limits<double>::epsilon();

/// Vectors and blocks of up to three rows: a normal and its tangents. Never on the heap.
using PointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using PointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
/// Vector with zeros for missing tangents, which stays in registers.
using PaddedVector = Eigen::Vector3d;

/// Point of the contact problem.
struct ContactPoint {
  Index point = 0;           ///< number of the point
  Index row = 0;             ///< its first row
  Index size = 1;            ///< number of rows
  double coefficient = 0.0;  ///< F, zero without tangents
  double bound = 0.0;        ///< of Tresca's law (F = 0) or of Coulomb's limited law (F > 0); zero if none
  double diagonal = 1.0;     ///< w, mean diagonal entry of W's block; without friction that of its normal

  [[nodiscard]] bool has_friction() const { return size > 1 && (coefficient > 0.0 || bound > 0.0); }
  /// True if the friction limit jumps from zero to the bound when the point is pressed.
  [[nodiscard]] bool is_tresca() const { return coefficient == 0.0 && bound > 0.0; }
  /// True if the friction limit under this normal reaction is the bound, not F r_N.
  [[nodiscard]] bool is_bounded(double normal) const {
    return bound > 0.0 && !(coefficient * normal < bound && coefficient > 0.0);
  }
  /// Largest friction under a normal reaction.
  [[nodiscard]] double friction_limit(double normal) const {
    if (!(normal > 0.0)) return 0.0;
    return is_bounded(normal) ? bound : coefficient * normal;
  }
};

/// Extract the rows of a point from a vector, padded, and write them back.
inline PaddedVector padded(const ContactPoint& point, const Vector& rows) {
  const double* at = rows.data() + point.row;
  return {at[0], point.size > 1 ? at[1] : 0.0, point.size > 2 ? at[2] : 0.0};
}
inline void enter(const ContactPoint& point, const PaddedVector& value, Vector& rows) {
  for (Index k = 0; k < point.size; ++k) rows[point.row + k] = value[k];
}

/// Block of W of one point with its normal eliminated, in the principal axes of the remainder.
struct PointOperator {
  double normal = 1.0;              ///< W_NN
  Eigen::Vector2d coupling, slope;  ///< W_TN; W_NT/W_NN in the principal axes
  Eigen::Vector2d stiffness, axis;  ///< of W_TT − W_TN W_NT/W_NN: eigenvalues, and the axis of the first
  Eigen::Matrix3d inverse;          ///< of W if it is sufficiently definite, padded with zeros; otherwise zero
  Eigen::Matrix3d block;            ///< W itself, padded with zeros

  [[nodiscard]] PaddedVector multiply(const PaddedVector& r) const { return block * r; }
};
PointOperator make_point_operator(const PointMatrix& block);

/// Returns r with which the point alone satisfies its law, u = q + W r, W its diagonal block. Stick if possible;
/// otherwise slip with u_T = −κ r_T, κ > 0: (W + κ diag(0, I)) r = −q and |r_T| = b, an equation for κ alone, which has
/// a root because |r_T| − b is positive at κ = 0 and not at infinity.
///
/// Under Tresca's law friction can press a point that would be open without: if both are solutions, a point that is
/// `pressed` stays so, and another stays open.
///
/// `slip_stiffness` is a guess of κ (negative: none), and receives the κ found, for the next call.
PaddedVector solve_point(const ContactPoint& point, const PointOperator& block, const PaddedVector& q, bool pressed,
                         double& slip_stiffness);
PaddedVector solve_point(const ContactPoint& point, const PointOperator& block, const PaddedVector& q,
                         bool pressed = false);

/// Projection on the cone |r_T| ≤ F r_N.
PaddedVector project_on_cone(double coefficient, const PaddedVector& r);

/// Returns e = r − P_K(r − û/w), û = u + (F |u_T|, 0, 0), in units of r: zero if and only if the law holds. At a point
/// with a friction bound, where the law is no cone complementarity, the map below with c = 1/w.
PaddedVector natural_map(const ContactPoint& point, const PaddedVector& reaction, const PaddedVector& motion);

/// Alart and Curnier's residual in units of u: the larger of
///   |e_N| = |min(u_N, r_N/c)|  and  |e_T| = |r_T − P_b(r_T − c u_T)|/c,  P_b the projection on the disc |·| ≤ b.
double alart_curnier_residual(const ContactPoint& point, double step, const PaddedVector& reaction,
                              const PaddedVector& motion);

}  // namespace ricochet
