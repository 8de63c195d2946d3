#pragma once

#include "ricochet/base/types.hpp"

/// @file Quantities that an equivalent mass preserves, in the coordinates of the mesh. (The library uses a frame of its
/// own for each body: mass/mass_conditions.hpp.)
namespace ricochet::test_support {

/// Returns the total mass, first and second moments: PᵃᵀmPᵇ with P = (1, x, y[, z]), (d+1) × (d+1).
[[nodiscard]] inline Matrix mass_moments(const SparseMatrix& mass, const Points& nodes) {
  Matrix monomials(nodes.cols(), nodes.rows() + 1);
  monomials.col(0).setOnes();
  monomials.rightCols(nodes.rows()) = nodes.transpose();
  return monomials.transpose() * (mass * monomials);
}

}  // namespace ricochet::test_support
