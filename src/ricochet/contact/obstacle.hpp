#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/base/space_vector.hpp"

/// @file Rigid obstacles. To add one: a file in obstacles/ with a class and its registration, and one line in
/// obstacle.cpp.
namespace ricochet {

/// The shape of a part of an obstacle's surface, for pictures: in 2D lines, the obstacle to the right of each, in the
/// order in which they follow each other; in 3D quadrilaterals that turn counterclockwise where one looks at them from
/// outside. Cells that meet share points; a quadrilateral at a pole has it twice.
struct ObstacleSurface {
  Points points;           ///< d × count
  std::vector<int> cells;  ///< indices of points, `corners` for each cell

  [[nodiscard]] int corners() const { return points.rows() == 2 ? 2 : 4; }
};

/// A rigid body seen from a point of space: how far its surface is, which way is out, and how it moves. Gaps and
/// normals are those at t = 0; an obstacle may translate, and turn in ways that leave its surface what it is. The
/// normal is the derivative of the gap.
class Obstacle {
 public:
  virtual ~Obstacle() = default;
  /// Signed distance to the surface, positive outside.
  [[nodiscard]] virtual double gap(const SpaceVector& position) const = 0;
  /// Unit normal out of the obstacle at the surface's nearest point.
  [[nodiscard]] virtual SpaceVector normal(const SpaceVector& position) const = 0;
  /// A unit normal of the step from one position to another: with some a > 0
  ///   n·(to − from) = a (gap(to) − gap(from)),
  /// so that a force along it works on a body that slides no more than a plane's does. The normal at the middle has
  /// this property on planes and spheres. For another surface override it: with n the normal at the middle, the
  /// direction of
  ///   n + (gap(to) − gap(from) − n·(to − from)) (to − from)/|to − from|²
  /// (the discrete gradient of O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449–467), and n itself where the bracket is
  /// rounding. A step that goes so far round that it leans by more than 60° from the normals at the ends gets the last.
  [[nodiscard]] virtual SpaceVector normal_of_step(const SpaceVector& from, const SpaceVector& to) const;
  /// Size of the rounding error of `gap` at this position: gaps no larger than this are zero.
  [[nodiscard]] virtual double gap_rounding(const SpaceVector& position) const = 0;
  /// The gap is a linear function of the position.
  [[nodiscard]] virtual bool is_flat() const = 0;
  /// The least radius of curvature where it bulges towards bodies; infinite where it is flat or hollow.
  [[nodiscard]] virtual double least_radius() const { return std::numeric_limits<double>::infinity(); }
  /// Whether its material moves at all.
  [[nodiscard]] virtual bool moves() const = 0;
  /// Displacement of the obstacle as a whole since t = 0: the gap at t is that of position − translation(t) at 0.
  [[nodiscard]] virtual SpaceVector translation(double time) const = 0;
  /// For pictures: the surface at t = 0, as far as `radius` around its point nearest to `centre`.
  [[nodiscard]] virtual ObstacleSurface surface(const Vector& centre, double radius) const = 0;
  /// For pictures: where points of `surface` are shown at a time. They go with the obstacle, if it does not say
  /// otherwise: those of a plane stay beside the body when the plane moves along itself, and turn with a turntable.
  [[nodiscard]] virtual Points surface_points(const Points& at_start, double time) const {
    return at_start.colwise() + Vector(translation(time));
  }
  /// Velocity of the obstacle's material at a position of its surface: v + ω × (position − its point at that time).
  [[nodiscard]] virtual SpaceVector surface_velocity(const SpaceVector& position, double time) const = 0;
};

using ObstacleConstructor = std::function<std::unique_ptr<Obstacle>(const Parameters& parameters)>;
using ObstacleRegistration = Registration<ObstacleConstructor>;

/// All types of obstacles. A program of one's own may add to them.
[[nodiscard]] Registry<ObstacleConstructor>& obstacle_registry();
/// By type, with the values of its keys; throws Error(invalid_input) that lists the types, or says which value is
/// missing, too many or wrong.
[[nodiscard]] std::unique_ptr<Obstacle> make_obstacle(const std::string& type, Parameters parameters);
/// At rest; `normal` of any length but zero, out of the obstacle.
[[nodiscard]] std::unique_ptr<Obstacle> make_plane(const Vector& point, const Vector& normal);

// For the files that define obstacles: what several of them have.
[[nodiscard]] Key obstacle_velocity_key();
/// Zero where none is given.
[[nodiscard]] Vector obstacle_velocity(const Parameters& parameters, Index dimension);
[[nodiscard]] inline Vector as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size()));
}

}  // namespace ricochet
