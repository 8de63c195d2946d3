#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <numbers>

#include "ricochet/rigid/shapes/grid_surface.hpp"

namespace ricochet {

namespace {

/// An infinite cylinder: a shaft with bodies outside, or a bore with bodies inside. Gap ±(|p| − R), with p the part of
/// x − o perpendicular to the axis. As for a sphere, the normal at the midpoint is the normal of a step.
class Cylinder final : public ObstacleShape {
 public:
  Cylinder(const Vector& centre, const Vector& axis, double radius, double side)
      : centre_(centre), axis_(unit_vector(axis, "the axis of a cylinder")), radius_(radius), sign_(side) {}

  [[nodiscard]] double gap(const SpaceVector& position) const override {
    return sign_ * (across(position).stableNorm() - radius_);
  }
  /// On the axis, where the nearest direction is undefined, returns an arbitrary perpendicular one.
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const override {
    const Eigen::Vector3d from_axis = across(position);
    const double distance = from_axis.stableNorm();
    return sign_ * (distance > 0.0 ? Eigen::Vector3d(from_axis / distance) : axis_.unitOrthogonal());
  }
  [[nodiscard]] SpaceVector normal_of_step(const SpaceVector& from, const SpaceVector& to) const override {
    return normal_at_middle(from, to);
  }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    return eight_roundings(position.lpNorm<1>() + centre_.lpNorm<1>() + radius_);
  }
  [[nodiscard]] double least_radius() const override {
    return sign_ > 0.0 ? radius_ : std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] SpaceVector centre() const override { return centre_; }
  [[nodiscard]] SymmetryAxis symmetry_axis() const override { return {true, axis_}; }

  /// Shows a piece of it beside the body along the axis.
  [[nodiscard]] ObstacleSurface surface(const Vector& centre, double radius) const override {
    const Eigen::Vector3d middle = centre_ + axis_.dot(Eigen::Vector3d(centre) - centre_) * axis_;
    const Eigen::Vector3d first = axis_.unitOrthogonal(), second = sign_ * axis_.cross(first);
    constexpr int sectors = 64, rings = 4;
    const double half = 2.0 * radius;
    return grid_surface(rings, sectors, true, [&](int ring, int sector) -> Eigen::Vector3d {
      const double angle = -2.0 * std::numbers::pi * sector / sectors;
      return middle + half * (2.0 * ring / rings - 1.0) * axis_ +
             radius_ * (std::cos(angle) * first + std::sin(angle) * second);
    });
  }

 private:
  [[nodiscard]] Eigen::Vector3d across(const SpaceVector& position) const {
    const Eigen::Vector3d from_centre = Eigen::Vector3d(position) - centre_;
    return from_centre - axis_.dot(from_centre) * axis_;
  }

  Eigen::Vector3d centre_, axis_;
  double radius_, sign_;
};

std::vector<Key> cylinder_keys() {
  return {vector_key("centre", "length", required(), "A point on the cylinder's axis."),
          vector_key("axis", "1", required(),
                     "Direction of the axis, of any length but zero. The cylinder has no ends; in two dimensions use a "
                     "sphere, which is a circle there."),
          number_key("radius", "length", required(positive), "Radius of the cylinder."),
          obstacle_side_key("Side of the bodies: \"outside\" a shaft, or \"inside\" a bore.")};
}

void check_cylinder(const ParameterCheck& check, const Parameters& values) {
  check_direction(check, values, "axis", "is the direction of the cylinder's axis");
}

}  // namespace

ObstacleRegistration cylinder_obstacle() {
  const auto make = [](const Parameters& parameters) {
    require_space(parameters, "centre", "a cylinder", "use a sphere, which is a circle there");
    return std::make_unique<Cylinder>(as_vector(parameters.vector("centre")), as_vector(parameters.vector("axis")),
                                      parameters.number("radius"), obstacle_side(parameters));
  };
  return {"cylinder", make, cylinder_keys(), {}, check_cylinder};
}

}  // namespace ricochet
