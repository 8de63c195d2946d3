#pragma once

#include <Eigen/Geometry>
#include <vector>

/// @file Removal of the rigid part of a motion, and forces of a couple.
namespace ricochet {

/// Removes from the motions of points the nearest linear rigid motion a + ω × x in the least-squares sense. The
/// remainder, as a set of forces, has no resultant and no moment about the points. All vectors have three components;
/// in 2D (`plane`) the third is 0.
void remove_rigid_part(const std::vector<Eigen::Vector3d>& positions, bool plane,
                       std::vector<Eigen::Vector3d>& motions);

/// Computes the smallest forces at points with the given moment and no resultant: ω × (x − x̄). For collinear points
/// the moment about their line is ignored.
void forces_of_couple(const std::vector<Eigen::Vector3d>& positions, bool plane, const Eigen::Vector3d& moment,
                      std::vector<Eigen::Vector3d>& forces);

}  // namespace ricochet
