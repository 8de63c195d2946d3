#include <Eigen/Geometry>

#include "ricochet/rigid/obstacle_shape.hpp"

namespace ricochet {

namespace {

/// The half-space below a plane: gap (x − p)·n.
class Plane final : public ObstacleShape {
 public:
  Plane(const Vector& point, const Vector& normal)
      : point_(point), normal_(unit_vector(normal, "the normal of a plane")) {}

  [[nodiscard]] double gap(const SpaceVector& position) const override { return (position - point_).dot(normal_); }
  [[nodiscard]] SpaceVector normal(const SpaceVector&) const override { return normal_; }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    const double size = (position.cwiseAbs() + point_.cwiseAbs()).dot(normal_.cwiseAbs());
    return eight_roundings(size);
  }
  [[nodiscard]] SpaceVector normal_of_step(const SpaceVector&, const SpaceVector&) const override { return normal_; }
  [[nodiscard]] bool is_flat() const override { return true; }
  [[nodiscard]] SpaceVector centre() const override { return point_; }
  [[nodiscard]] SymmetryAxis symmetry_axis() const override {
    return normal_.size() == 3 ? SymmetryAxis{true, normal_} : SymmetryAxis{};
  }
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

 private:
  Vector point_;
  Vector normal_;
};

std::vector<Key> plane_keys() {
  return {vector_key("point", "length", required(), "A point on the plane."),
          vector_key("normal", "1", required(),
                     "Normal of the plane, pointing out of the obstacle; of any length but zero.")};
}

void check_plane(const ParameterCheck& check, const Parameters& values) {
  check_direction(check, values, "normal", "points out of the obstacle");
}

}  // namespace

ObstacleRegistration plane_obstacle() {
  const auto make = [](const Parameters& parameters) {
    return std::make_unique<Plane>(as_vector(parameters.vector("point")), as_vector(parameters.vector("normal")));
  };
  return {"plane", make, plane_keys(), {}, check_plane};
}

}  // namespace ricochet
