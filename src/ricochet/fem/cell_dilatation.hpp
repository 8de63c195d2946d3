#pragma once

#include <array>
#include <cstddef>

#include "ricochet/base/packs.hpp"

/// @file Mean dilatation of a cell, or of the cells of a pack. Included by source files only (packs.hpp). Not
/// part of the public interface.
namespace ricochet {

inline constexpr int most_cell_points = 125;

/// Projection of functions given at the quadrature points of a cell onto φ_0 = 1 and optionally onto linear
/// functions of the reference coordinates, with the weights of the undeformed cell. `Number` is a double, or a
/// pack with one number per cell.
template <class Number>
class CellDilatation {
 public:
  static constexpr int most_functions = 4;

  /// Orthonormalizes `functions`, points × 1 or points × (d + 1), in the product of the positive `weights` per point.
  /// By Gram–Schmidt, applied twice for accuracy.
  RICOCHET_PART_OF_CALLER void start(const Matrix& functions, const Number* weights, int points) {
    points_ = std::size_t(points);
    weights_ = weights;
    count_ = int(functions.cols());
    const double* value = functions.data();
    for (int m = 0; m < count_; ++m) {
      Number* const own = orthonormal_[std::size_t(m)].data();
      for (std::size_t q = 0; q < points_; ++q) own[q] = Number{} + *value++;
      for (int time = 0; time < 2 && m > 0; ++time) {
        for (int n = 0; n < m; ++n) {
          const Number* const other = orthonormal_[std::size_t(n)].data();
          const Number part = product(own, other);
          for (std::size_t q = 0; q < points_; ++q) own[q] -= part * other[q];
        }
      }
      const Number scale = 1.0 / square_root(product(own, own));
      for (std::size_t q = 0; q < points_; ++q) own[q] *= scale;
    }
  }
  [[nodiscard]] int functions() const { return count_; }
  /// Computes P f at the points; symmetric in the product Σ w f g.
  RICOCHET_PART_OF_CALLER void project(const Number* values, Number* result) const {
    for (std::size_t q = 0; q < points_; ++q) result[q] = Number{};
    for (int m = 0; m < count_; ++m) {
      const Number* const own = orthonormal_[std::size_t(m)].data();
      const Number part = product(own, values);
      for (std::size_t q = 0; q < points_; ++q) result[q] += part * own[q];
    }
  }
  /// Orthonormal functions: P f = Σ_m ψ_m Σ w ψ_m f.
  [[nodiscard]] Number function(int m, int point) const { return orthonormal_[std::size_t(m)][std::size_t(point)]; }

 private:
  RICOCHET_PART_OF_CALLER Number product(const Number* a, const Number* b) const {
    Number sum{};
    for (std::size_t q = 0; q < points_; ++q) sum += weights_[q] * a[q] * b[q];
    return sum;
  }

  std::size_t points_ = 0;
  int count_ = 0;
  const Number* weights_ = nullptr;
  std::array<std::array<Number, most_cell_points>, most_functions> orthonormal_;  // set by start()
};

}  // namespace ricochet
