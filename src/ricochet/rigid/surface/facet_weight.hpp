#pragma once

#include <Eigen/Core>
#include <array>

/// @file How much of a facet is near to a point.
namespace ricochet {

/// Of the part of a facet that is nearer to x than ρ: ∫ (ρ² − |y − x|²), and its derivative with x, −2 ∫ (x − y). Both
/// are continuous in x.
struct FacetWeight {
  double value = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};
/// `normal` is that of the triangle, of length 1.
[[nodiscard]] FacetWeight weight_of_triangle(const std::array<Eigen::Vector3d, 3>& corners,
                                             const Eigen::Vector3d& normal, const Eigen::Vector3d& at, double radius);
[[nodiscard]] FacetWeight weight_of_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                            const Eigen::Vector3d& at, double radius);

}  // namespace ricochet
