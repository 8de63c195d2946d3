#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/contact/obstacle.hpp"

namespace ricochet {

namespace {

/// Of a vector of any length: where the square of the length leaves the range of numbers, it is scaled first.
Vector unit(const Vector& direction) {
  const double length = direction.norm();
  if (length == 0.0 && direction.isZero(0.0)) throw Error(ErrorKind::invalid_input, "the normal of a plane is zero");
  constexpr double smallest = 1e-150;
  if (std::isfinite(length) && length > smallest) return direction / length;
  return direction.stableNormalized();
}

constexpr const char* turns_in_space_only =
    "a plane turns about its normal, which needs three dimensions: leave rotation_rate out in 2D";

/// The half-space below a plane: gap (x − p)·n.
class Plane final : public Obstacle {
 public:
  Plane(const Vector& point, const Vector& normal, const Vector& velocity, double rotation_rate)
      : point_(point), normal_(unit(normal)), velocity_(velocity), rotation_rate_(rotation_rate) {
    if (rotation_rate_ != 0.0 && normal_.size() != 3) throw Error(ErrorKind::invalid_input, turns_in_space_only);
  }

  [[nodiscard]] double gap(const SpaceVector& position) const override { return (position - point_).dot(normal_); }
  [[nodiscard]] SpaceVector normal(const SpaceVector&) const override { return normal_; }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    const double size = (position.cwiseAbs() + point_.cwiseAbs()).dot(normal_.cwiseAbs());
    return 8.0 * std::numeric_limits<double>::epsilon() * size;
  }
  [[nodiscard]] bool is_flat() const override { return true; }
  [[nodiscard]] bool moves() const override { return rotation_rate_ != 0.0 || !velocity_.isZero(0.0); }
  [[nodiscard]] SpaceVector translation(double time) const override { return time * velocity_; }
  [[nodiscard]] ObstacleSurface surface(const Vector& centre, double radius) const override {
    const Vector middle = centre - gap(centre) * normal_;
    if (normal_.size() == 2) {
      const Eigen::Vector2d along(normal_[1], -normal_[0]);
      Points ends(2, 2);
      ends << middle - radius * along, middle + radius * along;
      return {ends, {0, 1}};
    }
    const Eigen::Vector3d axis = normal_;
    const Eigen::Vector3d first = axis.unitOrthogonal(), second = axis.cross(first);
    Points corners(3, 4);
    for (int k = 0; k < 4; ++k) {
      const double a = k == 0 || k == 3 ? -radius : radius, b = k < 2 ? -radius : radius;
      corners.col(k) = Eigen::Vector3d(middle) + a * first + b * second;
    }
    return {corners, {0, 1, 2, 3}};
  }
  /// What moves along the plane is not seen, what turns is.
  [[nodiscard]] Points surface_points(const Points& at_start, double time) const override {
    const Vector lift = translation(time).dot(normal_) * normal_;
    if (rotation_rate_ == 0.0) return at_start.colwise() + lift;
    const Eigen::Vector3d middle = at_start.rowwise().mean();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(rotation_rate_ * time, Eigen::Vector3d(normal_)).toRotationMatrix();
    return (turn * (at_start.colwise() - middle)).colwise() + (middle + Eigen::Vector3d(lift));
  }
  [[nodiscard]] SpaceVector surface_velocity(const SpaceVector& position, double time) const override {
    if (rotation_rate_ == 0.0) return velocity_;
    const Eigen::Vector3d axis = normal_;
    const Eigen::Vector3d arm = position - point_ - translation(time);
    return velocity_ + rotation_rate_ * axis.cross(arm);
  }

 private:
  Vector point_;
  Vector normal_;
  Vector velocity_;
  double rotation_rate_;
};

std::vector<Key> plane_keys() {
  return {
      {.name = "point", .type = KeyType::vector, .unit = "length", .required = true, .doc = "A point of the plane."},
      {.name = "normal",
       .type = KeyType::vector,
       .unit = "1",
       .required = true,
       .doc = "Normal of the plane, out of the obstacle; of any length but zero."},
      obstacle_velocity_key(),
      {.name = "rotation_rate",
       .type = KeyType::number,
       .unit = "angle/time",
       .standard = "0",
       .doc = "Rate in rad per time at which the plane turns about its normal through `point`, right-handed: a "
              "turntable. In three dimensions only."}};
}

void check_plane(const ParameterCheck& place, Parameters& values) {
  if (!place.is_usable("normal")) return;
  const std::vector<double>& normal = values.vector("normal");
  if (std::all_of(normal.begin(), normal.end(), [](double n) { return n == 0.0; }))
    place.add_problem("normal", "\"normal\" must not be zero: it points out of the obstacle");
  if (normal.size() != 3 && place.is_usable("rotation_rate") && values.number("rotation_rate") != 0.0)
    place.add_problem("rotation_rate", turns_in_space_only);
}

}  // namespace

ObstacleRegistration plane_obstacle() {
  const auto make = [](const Parameters& parameters) {
    const Vector point = as_vector(parameters.vector("point"));
    return std::make_unique<Plane>(point, as_vector(parameters.vector("normal")),
                                   obstacle_velocity(parameters, point.size()), parameters.number("rotation_rate"));
  };
  return {"plane", make, plane_keys(), {}, check_plane};
}

std::unique_ptr<Obstacle> make_plane(const Vector& point, const Vector& normal) {
  return std::make_unique<Plane>(point, normal, Vector::Zero(normal.size()), 0.0);
}

}  // namespace ricochet
