#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ricochet/simulation/history/quantity_sensor.hpp"

namespace ricochet {

namespace {

/// Sensor of a free rigid body.
class FreeBodySensor final : public QuantitySensor<FreeBodySensor> {
 public:
  FreeBodySensor(const std::string& name, const SemidiscreteProblem& problem, const Obstacle& obstacle)
      : QuantitySensor(name + ".", problem), problem_(problem), obstacle_(obstacle), body_(*obstacle.free_motion()) {}

  static const Quantities& quantities() {
    using Self = FreeBodySensor;
    static const Quantities all{
        {{"displacement", "length", "displacement of its centre of mass", ColumnComponents::vector, Reduction::same},
         member_value(&Self::displacement_)},
        {{"velocity", "length/time", "velocity of its centre of mass", ColumnComponents::vector, Reduction::same},
         member_value(&Self::velocity_)},
        {{"rotation", "angle",
          "rotation: in 2D the angle, whole turns included, in 3D the rotation vector, of length π at most",
          ColumnComponents::axial, Reduction::same},
         member_value(&Self::rotation_)},
        {{"spin", "angle/time", "angular velocity", ColumnComponents::axial, Reduction::same},
         member_value(&Self::spin_)},
        {{"contact_force", "force", "resultant of the contact forces on it", ColumnComponents::vector, Reduction::same},
         member_value(&Self::force_)},
    };
    return all;
  }

  void evaluate(const Observation& observation) {
    const State& state = observation.state;
    const Index d = problem_.dimension, first = body_.centre_node() * d;
    displacement_ = state.displacement.segment(first, d);
    velocity_ = state.velocity.segment(first, d);
    rotation_ = rotation(state.displacement);
    spin_ = body_.angular_velocity(state.displacement, state.velocity);
    force_ = SpaceVector::Zero(d);
    for (Index i = 0; i < problem_.contact.size(); ++i) {
      if (carries_force(state.forces, i) && problem_.obstacle_of_point(i) == &obstacle_)
        force_ -= contact_force(state.forces, i);
    }
  }

 private:
  /// In the plane the angle, whole turns included; in space the rotation vector, of length π at most.
  [[nodiscard]] SpaceVector rotation(const Vector& displacement) const {
    const Pose::Rotation matrix = body_.pose(displacement).rotation;
    if (problem_.dimension == 3) {
      const Eigen::AngleAxisd angle{Eigen::Matrix3d(matrix)};
      return angle.angle() * angle.axis();
    }
    const double angle = std::atan2(matrix(1, 0), matrix(0, 0));
    const double near = displacement[body_.rotation_node() * 2] / body_.gyration()[0];
    constexpr double whole = 2.0 * std::numbers::pi;
    return SpaceVector::Constant(1, angle + whole * std::round((near - angle) / whole));
  }

  const SemidiscreteProblem& problem_;
  const Obstacle& obstacle_;
  const FreeMotion& body_;
  SpaceVector displacement_, velocity_, rotation_, spin_, force_;
};

}  // namespace

std::vector<RowQuantity> free_body_quantities() { return FreeBodySensor::descriptions(); }

std::unique_ptr<Sensor> make_free_body_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                              const Obstacle& obstacle) {
  return std::make_unique<FreeBodySensor>(name, problem, obstacle);
}

}  // namespace ricochet
