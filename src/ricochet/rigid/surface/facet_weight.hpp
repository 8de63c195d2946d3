#pragma once

#include <Eigen/Core>
#include <array>

/// @file Weight of a facet near a point.
namespace ricochet {

/// Integral ∫ (ρ² − |y − x|²) over the part of a facet within distance ρ of x, and its derivative with respect to x, −2
/// ∫ (x − y). Both are continuous in x.
struct FacetWeight {
  double value = 0.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};
/// `normal` is the unit normal of the triangle.
[[nodiscard]] FacetWeight weight_of_triangle(const std::array<Eigen::Vector3d, 3>& corners,
                                             const Eigen::Vector3d& normal, const Eigen::Vector3d& at, double radius);
[[nodiscard]] FacetWeight weight_of_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                            const Eigen::Vector3d& at, double radius);

}  // namespace ricochet
