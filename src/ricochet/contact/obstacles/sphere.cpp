#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ricochet/contact/obstacle.hpp"

namespace ricochet {

namespace {

/// A ball that bodies stay outside of, gap |x − o| − R, or a hollow that they stay inside of, gap R − |x − o|. In the
/// plane a disc and a round hole.
class Sphere final : public Obstacle {
 public:
  Sphere(const Vector& centre, double radius, bool is_hollow, const Vector& velocity)
      : centre_(centre), radius_(radius), sign_(is_hollow ? -1.0 : 1.0), velocity_(velocity) {}

  [[nodiscard]] double gap(const SpaceVector& position) const override {
    return sign_ * ((position - centre_).stableNorm() - radius_);
  }
  /// At the centre, where no direction is nearest, that of the last axis.
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const override {
    const SpaceVector from_centre = position - centre_;
    const double distance = from_centre.stableNorm();
    if (distance > 0.0) return from_centre * (sign_ / distance);
    return sign_ * SpaceVector::Unit(position.size(), position.size() - 1);
  }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    const double size = position.lpNorm<1>() + centre_.lpNorm<1>() + radius_;
    return 8.0 * std::numeric_limits<double>::epsilon() * size;
  }
  [[nodiscard]] bool is_flat() const override { return false; }
  [[nodiscard]] bool moves() const override { return !velocity_.isZero(0.0); }
  [[nodiscard]] SpaceVector translation(double time) const override { return time * velocity_; }
  [[nodiscard]] SpaceVector surface_velocity(const SpaceVector&, double) const override { return velocity_; }

  /// An arc, or a cap of quadrilaterals, around the point nearest to `centre`; wider than asked for, since bodies slide
  /// and roll on it. The obstacle is to the right of the arc, and behind the quadrilaterals.
  [[nodiscard]] Points surface(const Vector& centre, double radius, double time) const override {
    const SpaceVector middle = centre_ + translation(time);
    const SpaceVector towards = sign_ * normal(centre - translation(time));
    const bool in_plane = towards.size() == 2;
    const double angle = std::min((in_plane ? 20.0 : 4.0) * radius / radius_, std::numbers::pi);
    // Chords whose sagitta is small beside the body.
    const double chord = std::min(std::sqrt(0.04 * radius / radius_), 0.1);
    const int pieces = std::clamp(static_cast<int>(std::ceil(angle / chord)), 8, in_plane ? 256 : 32);
    return in_plane ? arc(middle, towards, angle, pieces) : cap(middle, towards, angle, pieces);
  }

 private:
  [[nodiscard]] Points arc(const Eigen::Vector2d& middle, const Eigen::Vector2d& towards, double angle,
                           int pieces) const {
    Points result(2, 2 * pieces + 1);
    for (int k = 0; k <= 2 * pieces; ++k) {
      const double turned = -sign_ * angle * (static_cast<double>(k) / pieces - 1.0);
      result.col(k) = middle + radius_ * (Eigen::Rotation2Dd(turned) * towards);
    }
    return result;
  }

  [[nodiscard]] Points cap(const Eigen::Vector3d& middle, const Eigen::Vector3d& towards, double angle,
                           int rings) const {
    constexpr int sectors = 48;
    const Eigen::Vector3d first = towards.unitOrthogonal(), second = sign_ * towards.cross(first);
    const auto at = [&](int ring, int sector) -> Eigen::Vector3d {
      const double polar = angle * ring / rings, around = 2.0 * std::numbers::pi * sector / sectors;
      return middle + radius_ * (std::cos(polar) * towards +
                                 std::sin(polar) * (std::cos(around) * first + std::sin(around) * second));
    };
    Points result(3, 4 * rings * sectors);
    Index corner = 0;
    for (int ring = 0; ring < rings; ++ring) {
      for (int sector = 0; sector < sectors; ++sector) {
        result.col(corner++) = at(ring, sector);
        result.col(corner++) = at(ring + 1, sector);
        result.col(corner++) = at(ring + 1, sector + 1);
        result.col(corner++) = at(ring, sector + 1);
      }
    }
    return result;
  }

  SpaceVector centre_;
  double radius_;
  double sign_;  ///< of the normal along the direction from the centre
  SpaceVector velocity_;
};

std::vector<Key> sphere_keys() {
  return {{.name = "centre",
           .type = KeyType::vector,
           .unit = "length",
           .required = true,
           .doc = "Centre of the sphere; in two dimensions of the circle."},
          {.name = "radius",
           .type = KeyType::number,
           .unit = "length",
           .required = true,
           .range = positive,
           .doc = "Radius of the sphere."},
          {.name = "side",
           .type = KeyType::choice,
           .standard = "outside",
           .choices = {"outside", "inside"},
           .doc = "Where bodies are: \"outside\" of a ball, or \"inside\" of a hollow (a bowl)."},
          obstacle_velocity_key()};
}

}  // namespace

ObstacleRegistration sphere_obstacle() {
  const auto make = [](const Parameters& parameters) {
    const Vector centre = as_vector(parameters.vector("centre"));
    return std::make_unique<Sphere>(centre, parameters.number("radius"), parameters.text("side") == "inside",
                                    obstacle_velocity(parameters, centre.size()));
  };
  return {"sphere", make, sphere_keys()};
}

}  // namespace ricochet
