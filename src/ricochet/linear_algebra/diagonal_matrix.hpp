#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

namespace ricochet {

/// Returns a diagonal matrix; zeros are not stored.
[[nodiscard]] inline SparseMatrix diagonal_matrix(const Vector& diagonal) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < diagonal.size(); ++i) {
    if (diagonal[i] != 0.0) entries.emplace_back(int(i), int(i), diagonal[i]);
  }
  SparseMatrix result(diagonal.size(), diagonal.size());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace ricochet
