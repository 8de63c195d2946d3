#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Rigid obstacles. To add one: a class here or in a file of its own, and one line in `make_obstacle`.
namespace ricochet {

/// A rigid body seen from a point of space: how far its surface is, and which way is out.
class Obstacle {
 public:
  virtual ~Obstacle() = default;
  /// Signed distance to the surface, positive outside.
  [[nodiscard]] virtual double gap(const Vector& position) const = 0;
  /// Unit normal out of the obstacle at the surface's nearest point.
  [[nodiscard]] virtual Vector normal(const Vector& position) const = 0;
  /// Size of the rounding error of `gap` at this position: gaps no larger than this are zero.
  [[nodiscard]] virtual double gap_rounding(const Vector& position) const = 0;
};

/// What a case says of an obstacle.
struct ObstacleParameters {
  std::string type;
  Vector point;
  Vector normal;
};

/// Throws Error(invalid_input) for an unknown type, naming the known ones.
[[nodiscard]] std::unique_ptr<Obstacle> make_obstacle(const ObstacleParameters& parameters);
[[nodiscard]] std::vector<std::string> obstacle_types();

}  // namespace ricochet
