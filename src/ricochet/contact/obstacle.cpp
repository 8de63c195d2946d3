#include "ricochet/contact/obstacle.hpp"

namespace ricochet {

// The obstacles, each by the function of its own file that registers it. One line each, in the order of the
// documentation.
// clang-format off
#define RICOCHET_OBSTACLES(obstacle) \
  obstacle(plane_obstacle)           \
  obstacle(sphere_obstacle)
// clang-format on

RICOCHET_DEFINE_REGISTRY(obstacle_registry, ObstacleConstructor, "obstacle type", RICOCHET_OBSTACLES)

std::unique_ptr<Obstacle> make_obstacle(const std::string& type, Parameters parameters) {
  return obstacle_registry().find(type, parameters).type(parameters);
}

SpaceVector Obstacle::normal_of_step(const SpaceVector& from, const SpaceVector& to) const {
  const SpaceVector middle = normal(0.5 * (from + to)), end = normal(to);
  return middle.dot(end) > 0.5 && middle.dot(normal(from)) > 0.5 ? middle : end;
}

Key obstacle_velocity_key() {
  return {.name = "velocity",
          .type = KeyType::vector,
          .unit = "length/time",
          .doc =
              "Constant velocity of the obstacle; without it the obstacle rests. Friction acts on the velocity of the "
              "body relative to it, and obstacle_work is what it puts into the body."};
}

Vector obstacle_velocity(const Parameters& parameters, Index dimension) {
  return parameters.has("velocity") ? as_vector(parameters.vector("velocity")) : Vector(Vector::Zero(dimension));
}

}  // namespace ricochet
