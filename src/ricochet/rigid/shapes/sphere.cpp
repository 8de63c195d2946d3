#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ricochet/rigid/obstacle_shape.hpp"

namespace ricochet {

namespace {

/// Number of sectors in the rings of a sphere's picture.
constexpr int sectors = 48;

/// A ball with bodies outside, gap |x − o| − R, or a hollow with bodies inside, gap R − |x − o|. In the plane a disc
/// and a round hole.
class Sphere final : public ObstacleShape {
 public:
  Sphere(const Vector& centre, double radius, double side) : centre_(centre), radius_(radius), sign_(side) {}

  [[nodiscard]] double gap(const SpaceVector& position) const override {
    return sign_ * ((position - centre_).stableNorm() - radius_);
  }
  /// At the centre, where the nearest direction is undefined, returns that of the last axis.
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const override {
    const SpaceVector from_centre = position - centre_;
    const double distance = from_centre.stableNorm();
    if (distance > 0.0) return from_centre * (sign_ / distance);
    return sign_ * SpaceVector::Unit(position.size(), position.size() - 1);
  }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    const double size = position.lpNorm<1>() + centre_.lpNorm<1>() + radius_;
    return eight_roundings(size);
  }
  [[nodiscard]] SpaceVector normal_of_step(const SpaceVector& from, const SpaceVector& to) const override {
    return normal_at_middle(from, to);
  }
  [[nodiscard]] SpaceVector centre() const override { return centre_; }
  [[nodiscard]] std::optional<Solid> solid() const override {
    if (sign_ < 0.0) return std::nullopt;
    const double square = radius_ * radius_, pi = std::numbers::pi;
    if (centre_.size() == 2) return Solid{pi * square, centre_, Matrix::Constant(1, 1, 0.5 * pi * square * square)};
    const double volume = 4.0 / 3.0 * pi * square * radius_;
    return Solid{volume, centre_, 0.4 * volume * square * Matrix::Identity(3, 3)};
  }
  [[nodiscard]] SymmetryAxis symmetry_axis() const override { return {centre_.size() == 2, {}}; }
  [[nodiscard]] double least_radius() const override {
    return sign_ > 0.0 ? radius_ : std::numeric_limits<double>::infinity();
  }

  /// Shows an arc, or a cap of quadrilaterals, around the point nearest to `centre`, larger than requested, since
  /// bodies slide and roll on it. The obstacle is on the right of the arc, and behind the quadrilaterals.
  [[nodiscard]] ObstacleSurface surface(const Vector& centre, double radius) const override {
    const SpaceVector towards = sign_ * normal(centre);
    const bool in_plane = towards.size() == 2;
    const double angle = std::min((in_plane ? 20.0 : 4.0) * radius / radius_, std::numbers::pi);
    // Chords whose sagitta is small compared with the body; rings no wider than sectors at the equator.
    const double widest = in_plane ? 0.1 : 2.0 * std::numbers::pi / sectors;
    const double chord = std::min(std::sqrt(0.04 * radius / radius_), widest);
    const int pieces = std::clamp(int(std::ceil(angle / chord)), 8, in_plane ? 256 : 32);
    return in_plane ? arc(towards, angle, pieces) : cap(towards, angle, pieces);
  }

 private:
  [[nodiscard]] ObstacleSurface arc(const Eigen::Vector2d& towards, double angle, int pieces) const {
    const Eigen::Vector2d middle = centre_;
    ObstacleSurface result{Points(2, 2 * pieces + 1), {}};
    for (int k = 0; k <= 2 * pieces; ++k) {
      const double rotation = -sign_ * angle * (double(k) / pieces - 1.0);
      result.points.col(k) = middle + radius_ * (Eigen::Rotation2Dd(rotation) * towards);
      if (k > 0) result.cells.insert(result.cells.end(), {k - 1, k});
    }
    return result;
  }

  /// Makes rings around the pole at `towards`; those of a whole sphere end at the other pole.
  [[nodiscard]] ObstacleSurface cap(const Eigen::Vector3d& towards, double angle, int rings) const {
    const bool is_whole = angle >= std::numbers::pi;
    const Eigen::Vector3d middle = centre_, first = towards.unitOrthogonal(), second = sign_ * towards.cross(first);
    const auto index = [&](int ring, int sector) {
      if (ring == 0) return 0;
      return 1 + sectors * (ring - 1) + (is_whole && ring == rings ? 0 : sector % sectors);
    };
    ObstacleSurface result{Points(3, index(rings, sectors - 1) + 1), {}};
    for (int ring = 0; ring <= rings; ++ring) {
      for (int sector = 0; sector < sectors; ++sector) {
        const double polar = angle * ring / rings, around = 2.0 * std::numbers::pi * sector / sectors;
        result.points.col(index(ring, sector)) =
            middle + radius_ * (std::cos(polar) * towards +
                                std::sin(polar) * (std::cos(around) * first + std::sin(around) * second));
        if (ring == rings) continue;
        for (const int corner :
             {index(ring, sector), index(ring + 1, sector), index(ring + 1, sector + 1), index(ring, sector + 1)})
          result.cells.push_back(corner);
      }
    }
    return result;
  }

  SpaceVector centre_;
  double radius_;
  double sign_;  ///< of the normal along the direction from the centre
};

std::vector<Key> sphere_keys() {
  return {vector_key("centre", "length", required(), "Centre of the sphere; in two dimensions of the circle."),
          number_key("radius", "length", required(positive), "Radius of the sphere."),
          obstacle_side_key("Side of the bodies: \"outside\" a ball, or \"inside\" a hollow (a bowl).")};
}

}  // namespace

ObstacleRegistration sphere_obstacle() {
  const auto make = [](const Parameters& parameters) {
    return std::make_unique<Sphere>(as_vector(parameters.vector("centre")), parameters.number("radius"),
                                    obstacle_side(parameters));
  };
  return {"sphere", make, sphere_keys()};
}

}  // namespace ricochet
