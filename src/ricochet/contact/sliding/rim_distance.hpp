#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "ricochet/contact/mortar/facet_surface.hpp"
#include "ricochet/fem/polynomial_shape.hpp"

/// @file Rim of a surface, over which the points of another one slide.
///
/// At a rim a contact point would begin to face something at any overlap and at once with any force, so that a step may
/// have no solution: a force that moves the rim away ends the contact that exerts it. The rim is therefore rounded.
/// With ρ the distance from the rim (RimDistance), the cover c = (1/W) ∫ ψ ρ dA of a point over the part of its support
/// that faces the surface, W = ∫ ψ dA, and the size L of its facets, its gap is larger by
///   a(c) = κ l (1 − (c/c₀)^⅓)² where c < c₀ = ⅔ (l/L)³,   l = L/4,   κ = ½.
/// c grows with the third power of the distance s by which the rim has passed the next node of a hat function, and
/// reaches c₀ at s = l: over this distance the rim recedes by up to l/2, with a slope between 1 and 0.
namespace ricochet {

/// Width over which rims are rounded, in sizes of a facet: l/L, and the same for ρ.
inline constexpr double rim_width = 0.25;

/// Allowance a(c)/L at a rim, and its derivative.
struct RimAllowance {
  double value = 0.0, slope = 0.0;

  explicit RimAllowance(double cover) {
    constexpr double whole = 2.0 / 3.0 * rim_width * rim_width * rim_width, height = 0.5 * rim_width;
    if (!(cover < whole)) return;
    const double part = std::cbrt(cover / whole), left = 1.0 - part;
    value = height * left * left;
    slope = -2.0 / 3.0 * height * left * part / cover;
  }
};

/// ρ = min(1, distance from the nearest edge of the rim / (rim_width × size of the facet at that edge)) in the
/// reference configuration, continuous on the surface. An edge, in 2D a vertex, belongs to the rim if only one facet
/// has it.
class RimDistance {
 public:
  RimDistance(const DisplacementSpace& space, const FacetSurface& surface);

  struct Value {
    double distance = 1.0;                   ///< ρ
    std::array<double, 2> slopes{0.0, 0.0};  ///< ∂ρ/∂ξ along the reference axes of the facet
    [[nodiscard]] bool rises() const { return slopes[0] != 0.0 || slopes[1] != 0.0; }
  };
  /// Whether ρ may be below 1 somewhere on a facet, numbered through all blocks.
  [[nodiscard]] bool is_near(Index facet) const { return edges_at_.contains(facet); }
  /// Evaluates ρ on a facet at the point with this reference position.
  [[nodiscard]] Value evaluate(Index facet, const PolynomialMap<3>::Evaluation& reference) const;

 private:
  struct Edge {
    Eigen::Vector3d from, to;
    double width;
  };
  std::map<Index, std::vector<Edge>> edges_at_;  ///< per facet: edges of the rim that have a vertex of it
};

/// Returns the vector k with dρ = k · (dx_s − dx_m − h dn) for the projection x_m = x_s − h n of a point x_s along n
/// onto a facet with the map `at` and the slopes of ρ. In the plane (`plane`) facets have one axis.
[[nodiscard]] Eigen::Vector3d rim_direction(const PolynomialMap<3>::Evaluation& at, bool plane,
                                            const Eigen::Vector3d& n, const RimDistance::Value& to_rim);

}  // namespace ricochet
