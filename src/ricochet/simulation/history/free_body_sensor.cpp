#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "ricochet/simulation/history/sensor.hpp"

namespace ricochet {

namespace {

/// Sensor of a free rigid body.
class FreeBodySensor final : public Sensor {
 public:
  FreeBodySensor(const std::string& name, const SemidiscreteProblem& problem, const Obstacle& obstacle)
      : name_(name), problem_(problem), obstacle_(obstacle), body_(*obstacle.free_motion()) {}

  [[nodiscard]] Columns columns() const override {
    Columns result;
    const std::vector<std::string> axes{"x", "y", "z"};
    for (const char* const what : {"displacement", "velocity", "rotation", "spin", "contact_force"}) {
      const bool is_rotation = std::string(what) == "rotation" || std::string(what) == "spin";
      for (std::size_t k = is_rotation && problem_.dimension == 2 ? 2 : 0;
           k < (is_rotation ? 3 : static_cast<std::size_t>(problem_.dimension)); ++k)
        result.push_back({name_ + "." + what + "_" + axes[k], Reduction::same});
    }
    return result;
  }

  void observe(const Observation& observation, std::vector<double>& row) override {
    const State& state = observation.state;
    const Index d = problem_.dimension, first = body_.centre_node() * d;
    append(state.displacement.segment(first, d), row);
    append(state.velocity.segment(first, d), row);
    append(rotation(state.displacement), row);
    append(body_.angular_velocity(state.displacement, state.velocity), row);
    SpaceVector force = SpaceVector::Zero(d);
    for (Index i = 0; i < problem_.contact.size(); ++i) {
      if (carries_force(state.forces, i) && problem_.obstacle_of_point(i) == &obstacle_)
        force -= contact_force(state.forces, i);
    }
    append(force, row);
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

  std::string name_;
  const SemidiscreteProblem& problem_;
  const Obstacle& obstacle_;
  const FreeMotion& body_;
};

}  // namespace

std::unique_ptr<Sensor> make_free_body_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                              const Obstacle& obstacle) {
  return std::make_unique<FreeBodySensor>(name, problem, obstacle);
}

}  // namespace ricochet
