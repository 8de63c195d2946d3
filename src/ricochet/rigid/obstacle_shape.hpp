#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/base/space_vector.hpp"

/// @file Shapes of rigid obstacles. To add one: a file in obstacles/ with a class and its registration, and one line in
/// obstacle_shape.cpp.
namespace ricochet {

/// A part of an obstacle's surface, for pictures: in 2D lines, the obstacle to the right of each, in the order in which
/// they follow each other; in 3D quadrilaterals that turn counterclockwise where one looks at them from outside. Cells
/// that meet share points; a triangle has its last point twice.
struct ObstacleSurface {
  Points points;           ///< d × count
  std::vector<int> cells;  ///< indices of points, `corners` for each cell

  [[nodiscard]] int corners() const { return points.rows() == 2 ? 2 : 4; }
};

/// What a shape may want to know of the bodies that touch it.
struct ContactScale {
  double body_size = 0.0;  ///< the largest extent of the mesh
  double spacing = 0.0;    ///< the largest distance between neighbouring nodes of its contact groups; 0: it has none
};

/// A rigid body as it is described, seen from a point: how far its surface is, and which way is out. It is the obstacle
/// (obstacle.hpp) that moves.
class ObstacleShape {
 public:
  virtual ~ObstacleShape() = default;
  /// Signed distance to the surface, positive where bodies may be. Where the nearest point is on the border of a
  /// surface that has one, the distance.
  [[nodiscard]] virtual double gap(const SpaceVector& position) const = 0;
  /// Unit normal towards bodies: the direction of the derivative of the gap.
  [[nodiscard]] virtual SpaceVector normal(const SpaceVector& position) const = 0;
  /// ∇gap. Override it where it is no unit vector, as where edges are rounded by means.
  [[nodiscard]] virtual SpaceVector gradient(const SpaceVector& position) const { return normal(position); }
  /// A unit normal of the step from one position to another: with some a > 0
  ///   n·(to − from) = a (gap(to) − gap(from)),
  /// so that a force along it works on a body that slides no more than a plane's does. With d = ∇gap at the middle, the
  /// direction of
  ///   d + (gap(to) − gap(from) − d·(to − from)) (to − from)/|to − from|²
  /// (the discrete gradient of O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449–467), and of d itself where the bracket is
  /// rounding, with a part of the correction up to twice that. A step that goes so far round that it leans by more than
  /// 60° from the normals at the ends gets the last, or where that would give energy the direction across the step that
  /// is nearest to it.
  /// Override it where the normal at the middle has this property (`normal_at_middle`).
  [[nodiscard]] virtual SpaceVector normal_of_step(const SpaceVector& from, const SpaceVector& to) const;
  /// Size of the rounding error of `gap` at this position: gaps no larger than this are zero.
  [[nodiscard]] virtual double gap_rounding(const SpaceVector& position) const = 0;
  /// The gap is a linear function of the position.
  [[nodiscard]] virtual bool is_flat() const { return false; }
  /// The least radius of curvature where it bulges towards bodies; infinite where it is flat or hollow.
  [[nodiscard]] virtual double least_radius() const { return std::numeric_limits<double>::infinity(); }
  /// For pictures: the surface as far as `radius` around its point nearest to `centre`.
  [[nodiscard]] virtual ObstacleSurface surface(const Vector& centre, double radius) const = 0;
  /// The point that it turns about where a case names none; empty: the origin, in two dimensions or three.
  [[nodiscard]] virtual SpaceVector centre() const = 0;
  /// The axis through `centre` about which it may turn and stay the same surface, such as the normal of a plane; in 2D
  /// a circle has one, and no direction is needed.
  struct OwnAxis {
    bool exists = false;
    SpaceVector direction = {};  ///< a unit vector, in 3D
  };
  [[nodiscard]] virtual OwnAxis own_axis() const { return {}; }
  /// What it is filled with, of density 1: its volume (its area in 2D), centre of mass, and the tensor of inertia about
  /// that (1 × 1 in 2D). Nothing where it encloses nothing that is finite, or where bodies are inside.
  struct Solid {
    double volume = 0.0;
    SpaceVector centre;
    Matrix inertia;
  };
  [[nodiscard]] virtual std::optional<Solid> solid() const { return std::nullopt; }
  /// Called once, before the first gap is asked for.
  virtual void fit(const ContactScale&) {}
  /// What it takes for itself that results depend on: "normals are means over a radius of 0.01"; empty: nothing.
  [[nodiscard]] virtual std::string remarks() const { return {}; }
  /// Of the file that it comes from; empty: none.
  [[nodiscard]] virtual std::string checksum() const { return {}; }

 protected:
  /// The normal half way, or at the end of a step that goes far round.
  [[nodiscard]] SpaceVector normal_at_middle(const SpaceVector& from, const SpaceVector& to) const;
};

using ObstacleConstructor = std::function<std::unique_ptr<ObstacleShape>(const Parameters& parameters)>;
using ObstacleRegistration = Registration<ObstacleConstructor>;

/// All types of obstacles. A program of one's own may add to them.
[[nodiscard]] Registry<ObstacleConstructor>& obstacle_registry();
/// By type, with the values of its keys; throws Error(invalid_input) that lists the types, or says which value is
/// missing, too many or wrong.
[[nodiscard]] std::unique_ptr<ObstacleShape> make_obstacle_shape(const std::string& type, Parameters parameters);

// For the files that define shapes: what several of them have.
[[nodiscard]] inline Vector as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size()));
}
/// `side`: "outside" or "inside".
[[nodiscard]] Key obstacle_side_key(const std::string& doc);
/// +1 outside, −1 inside.
[[nodiscard]] double obstacle_side(const Parameters& parameters);
/// Of a vector of any length but zero; throws Error(invalid_input) that says what is.
[[nodiscard]] Vector unit_vector(const Vector& direction, const std::string& what);
/// Adds a problem where a vector of the case is zero.
void check_direction(const ParameterCheck& place, const Parameters& values, const std::string& key,
                     const std::string& meaning);
/// Throws Error(invalid_input) where a vector has two components: "a cylinder is in space; in two dimensions …".
void require_space(const Parameters& parameters, const std::string& key, const std::string& what,
                   const std::string& instead);
/// The direction of a gradient of the gap, corrected along a way so that it knows what the gap changes by on it:
///   gradient + (change − gradient·way) way/|way|²,
/// that of the gradient where the bracket is rounding, with a part of the correction up to twice that; of a step that
/// goes far round see ObstacleShape::normal_of_step.
[[nodiscard]] SpaceVector corrected_normal(SpaceVector gradient, const SpaceVector& way, double change, double rounding,
                                           const SpaceVector& at_start, const SpaceVector& at_end);
/// Eight roundings of a number of this size.
[[nodiscard]] inline double eight_roundings(double size) {
  return 8.0 * std::numeric_limits<double>::epsilon() * size;
}

}  // namespace ricochet
