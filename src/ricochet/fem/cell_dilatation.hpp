#pragma once

#include <array>

#include "ricochet/base/types.hpp"

/// @file Mean dilatation of a cell. Not part of the public interface.
namespace ricochet {

/// The projection of functions given at the quadrature points of a cell on φ_0 = 1 and, where wanted, on linear
/// functions of the reference coordinates, by the weights of the undeformed cell.
class CellDilatation {
 public:
  static constexpr int most_points = 125, most_functions = 4;

  /// `functions`: points × 1, or × (d + 1). `weights`: per point, positive.
  void start(const Matrix& functions, const double* weights, int points);
  [[nodiscard]] int functions() const { return count_; }
  /// P f at the points; symmetric in the product Σ w f g.
  void project(const double* values, double* result) const;
  /// Orthonormal functions: P f = Σ_m ψ_m Σ w ψ_m f.
  [[nodiscard]] double function(int m, int point) const {
    return orthonormal_[static_cast<std::size_t>(m)][static_cast<std::size_t>(point)];
  }

 private:
  int points_ = 0, count_ = 0;
  const double* weights_ = nullptr;
  std::array<std::array<double, most_points>, most_functions> orthonormal_;  // set by start()
};

}  // namespace ricochet
