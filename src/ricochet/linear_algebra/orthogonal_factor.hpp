#pragma once

#include <Eigen/Core>

namespace ricochet {

/// Returns the orthogonal factor R of a 3 × 3 matrix A = R S with a positive determinant, by Newton's iteration R ← ½(R
/// + R⁻ᵀ) (N. J. Higham, SIAM J. Sci. Stat. Comput. 7 (1986) 1160–1174). For A = Σ x'xᵀ, over positions x relative to
/// their mean and positions x' after a motion, R is the rotation that fits best. Returns I if the matrix has no
/// well-defined factor.
[[nodiscard]] Eigen::Matrix3d orthogonal_factor(Eigen::Matrix3d matrix);

}  // namespace ricochet
