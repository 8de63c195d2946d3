#include "ricochet/linear_algebra/orthogonal_factor.hpp"

#include <Eigen/LU>

namespace ricochet {

Eigen::Matrix3d orthogonal_factor(Eigen::Matrix3d matrix) {
  constexpr int max_steps = 60;
  const double size = matrix.norm();
  if (!(matrix.determinant() > 1e-12 * size * size * size)) return Eigen::Matrix3d::Identity();
  for (int step = 0; step < max_steps; ++step) {
    const Eigen::Matrix3d next = 0.5 * (matrix + matrix.inverse().transpose());
    const double change = (next - matrix).norm();
    matrix = next;
    if (change < 1e-14) break;
  }
  return matrix;
}

}  // namespace ricochet
