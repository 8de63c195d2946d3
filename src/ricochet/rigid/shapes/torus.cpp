#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "ricochet/rigid/shapes/grid_surface.hpp"

namespace ricochet {

namespace {

/// A ring with bodies outside, or a closed round pipe with bodies inside. With ρ and z perpendicular to and along the
/// axis, the gap is ±(√((ρ − R)² + z²) − r).
class Torus final : public ObstacleShape {
 public:
  Torus(const Vector& centre, const Vector& axis, double ring_radius, double tube_radius, double side)
      : centre_(centre),
        axis_(unit_vector(axis, "the axis of a torus")),
        ring_radius_(ring_radius),
        tube_radius_(tube_radius),
        sign_(side) {}

  [[nodiscard]] double gap(const SpaceVector& position) const override {
    return sign_ * (from_ring(position).stableNorm() - tube_radius_);
  }
  /// On the centre line of the tube, where the nearest direction is undefined, returns that of the axis.
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const override {
    const Eigen::Vector3d offset = from_ring(position);
    const double distance = offset.stableNorm();
    return sign_ * (distance > 0.0 ? Eigen::Vector3d(offset / distance) : axis_);
  }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    return eight_roundings(position.lpNorm<1>() + centre_.lpNorm<1>() + ring_radius_ + tube_radius_);
  }
  /// From inside the tube, the side towards the axis is the convex one, along the ring.
  [[nodiscard]] double least_radius() const override {
    return sign_ > 0.0 ? tube_radius_ : ring_radius_ - tube_radius_;
  }
  [[nodiscard]] SpaceVector centre() const override { return centre_; }
  [[nodiscard]] std::optional<Solid> solid() const override {
    if (sign_ < 0.0) return std::nullopt;
    const double ring = ring_radius_ * ring_radius_, tube = tube_radius_ * tube_radius_;
    const double volume = 2.0 * std::numbers::pi * std::numbers::pi * ring_radius_ * tube;
    const double across = 0.5 * ring + 0.625 * tube, along = ring + 0.75 * tube;
    const Eigen::Matrix3d inertia = across * Eigen::Matrix3d::Identity() + (along - across) * axis_ * axis_.transpose();
    return Solid{volume, centre_, volume * inertia};
  }
  [[nodiscard]] SymmetryAxis symmetry_axis() const override { return {true, axis_}; }

  [[nodiscard]] ObstacleSurface surface(const Vector&, double) const override {
    const Eigen::Vector3d first = axis_.unitOrthogonal(), second = axis_.cross(first);
    constexpr int around = 96, section = 32;
    return grid_surface(section, around, true, [&](int i, int k) -> Eigen::Vector3d {
      const double around_axis = 2.0 * std::numbers::pi * k / around,
                   in_tube = -sign_ * 2.0 * std::numbers::pi * i / section;
      const Eigen::Vector3d out = std::cos(around_axis) * first + std::sin(around_axis) * second;
      return centre_ + (ring_radius_ + tube_radius_ * std::cos(in_tube)) * out +
             tube_radius_ * std::sin(in_tube) * axis_;
    });
  }

 private:
  /// Vector from the nearest point of the ring; for a point on the axis, from an arbitrary one.
  [[nodiscard]] Eigen::Vector3d from_ring(const SpaceVector& position) const {
    const Eigen::Vector3d from_centre = Eigen::Vector3d(position) - centre_;
    const Eigen::Vector3d across = from_centre - axis_.dot(from_centre) * axis_;
    const double distance = across.stableNorm();
    const Eigen::Vector3d out = distance > 0.0 ? Eigen::Vector3d(across / distance) : axis_.unitOrthogonal();
    return from_centre - ring_radius_ * out;
  }

  Eigen::Vector3d centre_, axis_;
  double ring_radius_, tube_radius_, sign_;
};

std::vector<Key> torus_keys() {
  return {
      vector_key("centre", "length", required(), "Centre of the torus."),
      vector_key("axis", "1", required(), "Direction of the axis of rotational symmetry, of any length but zero."),
      number_key("ring_radius", "length", required(positive), "Distance of the centre line of the tube from the axis."),
      number_key("tube_radius", "length", required(positive), "Radius of the tube, less than `ring_radius`."),
      obstacle_side_key("Side of the bodies: \"outside\" a ring, or \"inside\" a pipe.")};
}

void check_torus(const ParameterCheck& check, const Parameters& values) {
  check_direction(check, values, "axis", "is the direction of the torus' axis");
  if (check.is_usable("ring_radius") && check.is_usable("tube_radius") &&
      values.number("tube_radius") >= values.number("ring_radius"))
    check.add_problem("tube_radius",
                      "\"tube_radius\" must be less than \"ring_radius\": the torus would intersect itself");
}

}  // namespace

ObstacleRegistration torus_obstacle() {
  const auto make = [](const Parameters& parameters) {
    require_space(parameters, "centre", "a torus", "use two circles");
    return std::make_unique<Torus>(as_vector(parameters.vector("centre")), as_vector(parameters.vector("axis")),
                                   parameters.number("ring_radius"), parameters.number("tube_radius"),
                                   obstacle_side(parameters));
  };
  return {"torus", make, torus_keys(), {}, check_torus};
}

}  // namespace ricochet
