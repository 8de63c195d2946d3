#pragma once

#include "ricochet/simulation/impact/impact.hpp"

/// @file Spurious growth, at small strain, of a body that rotates during contact.
///
/// The linear law moves the points of a body that rotates by φ along their tangents, to X + φ × X: a point at `a` from
/// the centre of mass moves too far from it, by −½ φ × (φ × a). The surface thus approaches the obstacle at a speed g
/// that no real body has. An obstacle that moves at this speed has the same effect: while a force acts, the body
/// rebounds faster by 2 ⟨g⟩, ⟨g⟩ the mean over the impulse.
namespace ricochet {

/// Rotation of one body in an impact.
struct RotatingBody {
  /// At the start of the impact: mean rotation of the displacement.
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin_before = Eigen::Vector3d::Zero(), spin_after = Eigen::Vector3d::Zero();
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  ///< from the centre of mass to the contact
};

/// Returns ⟨g⟩ along a direction out of the body, for a force ∝ sin(πt/T) over the duration T and the spin that it
/// changes.
[[nodiscard]] double rotation_growth(const RotatingBody& body, const Eigen::Vector3d& outward, double duration);

/// Returns the excess of a restitution due to this growth; 0 if there is no restitution.
[[nodiscard]] double restitution_excess(const Impact& impact);
/// Limit of this excess above which small strain does not hold in the impact, even if cells rotate only little.
constexpr double restitution_excess_limit = 0.01;
[[nodiscard]] bool is_distorted_by_rotation(const Impact& impact);

}  // namespace ricochet
