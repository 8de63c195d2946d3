#pragma once

#include "ricochet/simulation/impact/impact.hpp"

/// @file What small strain makes of a body that turns while it touches.
///
/// The linear law moves the points of a body that turns by φ along their tangents, to X + φ × X: a point at `a` from
/// the centre of mass gets too far from it, by −½ φ × (φ × a). So the surface runs towards the obstacle at a speed g
/// that no real body has. The obstacle might as well move by that: where a force acts, the body leaves at 2 ⟨g⟩ more,
/// ⟨g⟩ the mean over the impulse.
namespace ricochet {

/// In an impact, of one body.
struct TurningBody {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  ///< at its begin: the mean rotation of the displacement
  Eigen::Vector3d spin_before = Eigen::Vector3d::Zero(), spin_after = Eigen::Vector3d::Zero();
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  ///< from its centre of mass to where it touches
};

/// ⟨g⟩ along a direction out of the body: of a force ∝ sin(πt/T) over the duration T, and a spin that changes by it.
[[nodiscard]] double turn_growth(const TurningBody& body, const Eigen::Vector3d& outward, double duration);

/// By how much a restitution is too large for that; 0 where there is none.
[[nodiscard]] double restitution_by_turning(const Impact& impact);
/// Small strain does not hold in the impact where that is more, though cells may turn by little.
constexpr double restitution_by_turning_limit = 0.01;
[[nodiscard]] bool is_changed_by_turning(const Impact& impact);

}  // namespace ricochet
