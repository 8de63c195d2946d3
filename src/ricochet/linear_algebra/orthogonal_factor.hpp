#pragma once

#include <Eigen/Core>

namespace ricochet {

/// The orthogonal factor R of a matrix A = RS with a positive determinant, 3 × 3, by Newton's iteration
/// R ← ½(R + R⁻ᵀ) (N. J. Higham, SIAM J. Sci. Stat. Comput. 7 (1986) 1160–1174): of Σ x'xᵀ, over places x about their
/// mean and where they are afterwards, it is the rotation that fits best. A matrix that has none to speak of gives I.
[[nodiscard]] Eigen::Matrix3d orthogonal_factor(Eigen::Matrix3d matrix);

}  // namespace ricochet
