#pragma once

#include "ricochet/base/types.hpp"

namespace ricochet {

/// Returns p > 0 with p_i (a_i + ½(Wp)_i) = c_i, the only minimum of a·p + ¼pᵀWp − Σc_i ln p_i, which is convex:
/// Newton's method in ln p, from the solution for a diagonal W. Throws Error(not_converged).
[[nodiscard]] Vector restoring_impulses(const Matrix& w, const Vector& approach, const Vector& lost);

}  // namespace ricochet
