#include "ricochet/fem/cell_dilatation.hpp"

#include <cmath>

namespace ricochet {

/// Gram–Schmidt, twice for the digits.
void CellDilatation::start(const Matrix& functions, const double* weights, int points) {
  points_ = points;
  weights_ = weights;
  count_ = static_cast<int>(functions.cols());
  const auto product = [&](const auto& a, const auto& b) {
    double sum = 0.0;
    for (std::size_t q = 0; q < static_cast<std::size_t>(points_); ++q) sum += weights_[q] * a[q] * b[q];
    return sum;
  };
  for (int m = 0; m < count_; ++m) {
    auto& own = orthonormal_[static_cast<std::size_t>(m)];
    for (int q = 0; q < points_; ++q) own[static_cast<std::size_t>(q)] = functions(q, m);
    for (int time = 0; time < 2; ++time) {
      for (int n = 0; n < m; ++n) {
        const auto& other = orthonormal_[static_cast<std::size_t>(n)];
        const double part = product(own, other);
        for (std::size_t q = 0; q < static_cast<std::size_t>(points_); ++q) own[q] -= part * other[q];
      }
    }
    const double size = std::sqrt(product(own, own));
    for (std::size_t q = 0; q < static_cast<std::size_t>(points_); ++q) own[q] /= size;
  }
}

void CellDilatation::project(const double* values, double* result) const {
  for (int q = 0; q < points_; ++q) result[q] = 0.0;
  for (int m = 0; m < count_; ++m) {
    const auto& own = orthonormal_[static_cast<std::size_t>(m)];
    double part = 0.0;
    for (std::size_t q = 0; q < static_cast<std::size_t>(points_); ++q) part += weights_[q] * own[q] * values[q];
    for (std::size_t q = 0; q < static_cast<std::size_t>(points_); ++q) result[q] += part * own[q];
  }
}

}  // namespace ricochet
