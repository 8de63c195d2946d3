#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Frictionless complementarity problems of a few hundred points.
namespace ricochet {

/// Returns r with 0 ≤ r ⟂ H r − b ≥ 0, H symmetric and positive definite, by block principal pivoting from the points
/// with `first` ≠ 0 (J. J. Júdice, F. M. Pires, Comput. Oper. Res. 21 (1994) 587–596). It terminates for every H: if
/// exchanging all wrong points does not help, one is exchanged, in order. Throws Error(not_converged) if H is not
/// positive definite.
[[nodiscard]] Vector dense_complementarity(const Matrix& h, const Vector& b, const std::vector<char>& first);

}  // namespace ricochet
