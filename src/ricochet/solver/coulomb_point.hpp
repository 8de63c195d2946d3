#pragma once

#include <Eigen/Core>

#include "ricochet/base/types.hpp"

/// @file Contact and friction at one point: the law, its exact solution and its residual.
namespace ricochet {

/// Up to three rows: a normal and its tangents. Never on the heap.
using PointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using PointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// A contact point of the condensed problem.
struct CoulombPoint {
  Index point = 0;           ///< its number
  Index first = 0;           ///< its first row
  Index size = 1;            ///< number of rows
  double coefficient = 0.0;  ///< F, zero where there are no tangents
  double bound = 0.0;        ///< of Tresca's law (F = 0) or of Coulomb's limited law (F > 0); zero: no bound
  double step = 1.0;         ///< c, a power of two near 1/W_ii
  double weight = 1.0;       ///< a power of two; weight·u compares between points, ρ/weight too

  [[nodiscard]] bool has_friction() const { return size > 1 && (coefficient > 0.0 || bound > 0.0); }
  /// The friction limit jumps from zero to the bound where the point is pressed.
  [[nodiscard]] bool is_tresca() const { return coefficient == 0.0 && bound > 0.0; }
  /// The friction limit is the bound under this normal reaction, not F r_N.
  [[nodiscard]] bool is_bounded(double normal) const {
    return bound > 0.0 && !(coefficient * normal < bound && coefficient > 0.0);
  }
  /// Largest friction under a normal reaction.
  [[nodiscard]] double friction_limit(double normal) const {
    if (!(normal > 0.0)) return 0.0;
    return is_bounded(normal) ? bound : coefficient * normal;
  }
};

/// ρ with which the point alone satisfies its law, u = q + W ρ, W its diagonal block. Stick where it can; otherwise
/// slip with u_T = −κ ρ_T, κ > 0: (W + κ diag(0, I)) ρ = −q and |ρ_T| = b, an equation for κ alone, which has a root
/// because |ρ_T| − b is positive at κ = 0 and not at infinity.
///
/// Under Tresca's law friction can press a point that would be open without: where both are solutions a point that is
/// `pressed` stays so, and another stays open.
PointVector solve_point(const CoulombPoint& point, const PointMatrix& operator_matrix, const PointVector& offset,
                        bool pressed = false);

/// The natural map in units of u: largest of |e_N| and |e_T|, see CoulombSolver.
double natural_residual(const CoulombPoint& point, const PointVector& reaction, const PointVector& motion);

}  // namespace ricochet
