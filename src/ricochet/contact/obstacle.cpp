#include "ricochet/contact/obstacle.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <cmath>
#include <functional>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// Of a vector of any length: where the square of the length leaves the range of numbers, it is scaled first.
Vector unit(const Vector& direction) {
  const double length = direction.norm();
  constexpr double smallest = 1e-150;
  if (std::isfinite(length) && length > smallest) return direction / length;
  return direction.stableNormalized();
}

/// The half-space below a plane: gap (x − p)·n.
class Plane final : public Obstacle {
 public:
  explicit Plane(const ObstacleParameters& parameters)
      : point_(parameters.point),
        normal_(unit(parameters.normal)),
        velocity_(parameters.velocity.size() > 0 ? parameters.velocity : Vector::Zero(parameters.normal.size())),
        rotation_rate_(parameters.rotation_rate) {
    if (rotation_rate_ != 0.0 && normal_.size() != 3) {
      throw Error(ErrorKind::invalid_input,
                  "a plane turns about its normal, which needs three dimensions: leave rotation_rate out in 2D");
    }
  }

  [[nodiscard]] double gap(const Vector& position) const override { return (position - point_).dot(normal_); }
  [[nodiscard]] Vector normal(const Vector&) const override { return normal_; }
  [[nodiscard]] double gap_rounding(const Vector& position) const override {
    const double size = (position.cwiseAbs() + point_.cwiseAbs()).dot(normal_.cwiseAbs());
    return 8.0 * std::numeric_limits<double>::epsilon() * size;
  }
  [[nodiscard]] bool moves() const override { return rotation_rate_ != 0.0 || !velocity_.isZero(0.0); }
  [[nodiscard]] SpaceVector translation(double time) const override { return time * velocity_; }
  /// What moves along the plane is not seen, what turns is.
  [[nodiscard]] Points surface(const Vector& centre, double radius, double time) const override {
    const Vector lift = translation(time).dot(normal_) * normal_;
    const Vector middle = centre - gap(centre) * normal_ + lift;
    if (normal_.size() == 2) {
      const Eigen::Vector2d along(normal_[1], -normal_[0]);
      Points ends(2, 2);
      ends << middle - radius * along, middle + radius * along;
      return ends;
    }
    const Eigen::Vector3d axis = normal_;
    const Eigen::Vector3d first = Eigen::AngleAxisd(rotation_rate_ * time, axis) * axis.unitOrthogonal().eval();
    const Eigen::Vector3d second = axis.cross(first);
    Points corners(3, 4);
    for (int k = 0; k < 4; ++k) {
      const double a = k == 0 || k == 3 ? -radius : radius, b = k < 2 ? -radius : radius;
      corners.col(k) = Eigen::Vector3d(middle) + a * first + b * second;
    }
    return corners;
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

struct ObstacleRegistration {
  std::string type;
  std::function<std::unique_ptr<Obstacle>(const ObstacleParameters&)> make;
};

const std::vector<ObstacleRegistration>& obstacle_registrations() {
  static const std::vector<ObstacleRegistration> all{
      {"plane", [](const ObstacleParameters& p) { return std::make_unique<Plane>(p); }},
  };
  return all;
}

}  // namespace

std::vector<std::string> obstacle_types() {
  std::vector<std::string> names;
  for (const ObstacleRegistration& entry : obstacle_registrations()) names.push_back(entry.type);
  return names;
}

std::unique_ptr<Obstacle> make_obstacle(const ObstacleParameters& parameters) {
  for (const ObstacleRegistration& entry : obstacle_registrations()) {
    if (entry.type == parameters.type) return entry.make(parameters);
  }
  throw Error(ErrorKind::invalid_input,
              fmt::format("unknown obstacle type \"{}\"; known: {}", parameters.type, join_names(obstacle_types())));
}

}  // namespace ricochet
