#pragma once

#include <Eigen/Geometry>
#include <vector>

/// @file What of a motion is none of a rigid body, and what of forces is a couple.
namespace ricochet {

/// Takes off the motions of places that linear rigid motion a + ω × x which is nearest to them, by least squares. What
/// is left has no resultant and no moment about the places, whatever these are. Everything has three coordinates; in
/// two dimensions (`plane`) the third is 0.
void take_off_rigid_part(const std::vector<Eigen::Vector3d>& places, bool plane, std::vector<Eigen::Vector3d>& motions);

/// The smallest forces at places that have this moment and no resultant: ω × (x − x̄). Of places on a line the moment
/// about it is left out.
void forces_of_couple(const std::vector<Eigen::Vector3d>& places, bool plane, const Eigen::Vector3d& moment,
                      std::vector<Eigen::Vector3d>& forces);

}  // namespace ricochet
