#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/base/space_vector.hpp"

/// @file Shapes of rigid obstacles. A new one needs a file in rigid/shapes/ with a class and its registration, and one
/// line in obstacle_shape.cpp.
namespace ricochet {

/// A part of an obstacle's surface, for pictures: in 2D consecutive line segments with the obstacle on their right, in
/// 3D quadrilaterals oriented counterclockwise seen from outside. Adjacent cells share points; a triangle repeats its
/// last point.
struct ObstacleSurface {
  Points points;           ///< d × count
  std::vector<int> cells;  ///< indices of points, `corners` for each cell

  [[nodiscard]] int corners() const { return points.rows() == 2 ? 2 : 4; }
};

/// Lengths of the bodies in contact to which a shape may adapt.
struct ContactScale {
  double body_size = 0.0;  ///< the largest extent of the mesh
  double spacing = 0.0;    ///< the largest distance between neighbouring nodes of its contact groups; 0 if none
};

/// A rigid body in the frame of its description: distance to its surface and outward direction at a point. The obstacle
/// (obstacle.hpp) adds the motion.
class ObstacleShape {
 public:
  virtual ~ObstacleShape() = default;
  /// Signed distance to the surface, positive where bodies may be. If the nearest point is on the border of an open
  /// surface, the unsigned distance.
  [[nodiscard]] virtual double gap(const SpaceVector& position) const = 0;
  /// Unit normal towards bodies: the direction of the derivative of the gap.
  [[nodiscard]] virtual SpaceVector normal(const SpaceVector& position) const = 0;
  /// ∇gap. To be overridden if it is not a unit vector, as where edges are rounded by averaging.
  [[nodiscard]] virtual SpaceVector gradient(const SpaceVector& position) const { return normal(position); }
  /// Returns a unit normal of the step from one position to another: with some a > 0
  ///   n·(to − from) = a (gap(to) − gap(from)),
  /// so that a force along it does no more work on a sliding body than the force of a plane. With d = ∇gap at the
  /// midpoint, it has the direction of
  ///   d + (gap(to) − gap(from) − d·(to − from)) (to − from)/|to − from|²
  /// (the discrete gradient of O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449–467), and of d itself if the bracket is of
  /// the size of rounding errors; up to twice that size a part of the correction applies. If this direction deviates by
  /// more than 60° from the normal at either end of a long step, the result is the normal at the end or, if that would
  /// create energy, the direction perpendicular to the step that is nearest to it. To be overridden if the normal at
  /// the midpoint has this property (`normal_at_middle`).
  [[nodiscard]] virtual SpaceVector normal_of_step(const SpaceVector& from, const SpaceVector& to) const;
  /// Size of the rounding error of `gap` at this position: smaller gaps count as zero.
  [[nodiscard]] virtual double gap_rounding(const SpaceVector& position) const = 0;
  /// Whether the gap is a linear function of the position.
  [[nodiscard]] virtual bool is_flat() const { return false; }
  /// Smallest radius of curvature where the surface is convex towards bodies; infinite if it is flat or concave.
  [[nodiscard]] virtual double least_radius() const { return std::numeric_limits<double>::infinity(); }
  /// For pictures: the surface within `radius` of its point nearest to `centre`.
  [[nodiscard]] virtual ObstacleSurface surface(const Vector& centre, double radius) const = 0;
  /// Point about which it rotates by default; empty: the origin, in two or three dimensions.
  [[nodiscard]] virtual SpaceVector centre() const = 0;
  /// Axis through `centre` about which a rotation leaves the surface unchanged, such as the normal of a plane; a circle
  /// in 2D has one, and needs no direction.
  struct SymmetryAxis {
    bool exists = false;
    SpaceVector direction = {};  ///< a unit vector, in 3D
  };
  [[nodiscard]] virtual SymmetryAxis symmetry_axis() const { return {}; }
  /// The body filled with density 1: its volume (area in 2D), centre of mass, and inertia tensor about it
  /// (1 × 1 in 2D). None if it does not enclose a finite body, or if bodies are inside.
  struct Solid {
    double volume = 0.0;
    SpaceVector centre;
    Matrix inertia;
  };
  [[nodiscard]] virtual std::optional<Solid> solid() const { return std::nullopt; }
  /// Is called once, before the first gap is computed.
  virtual void fit(const ContactScale&) {}
  /// Choices of its own on which results depend: "normals are means over a radius of 0.01"; empty: none.
  [[nodiscard]] virtual std::string remarks() const { return {}; }
  /// Checksum of the file that defines it; empty if none.
  [[nodiscard]] virtual std::string checksum() const { return {}; }

 protected:
  /// Normal at the midpoint, or at the end of a step that rotates the normal too far.
  [[nodiscard]] SpaceVector normal_at_middle(const SpaceVector& from, const SpaceVector& to) const;
};

using ObstacleConstructor = std::function<std::unique_ptr<ObstacleShape>(const Parameters& parameters)>;
using ObstacleRegistration = Registration<ObstacleConstructor>;

/// All types of obstacles. A user's own program may add further ones.
[[nodiscard]] Registry<ObstacleConstructor>& obstacle_registry();
/// Makes a shape of a type from the values of its keys; throws Error(invalid_input) that lists the types, or says which
/// value is missing, superfluous or wrong.
[[nodiscard]] std::unique_ptr<ObstacleShape> make_obstacle_shape(const std::string& type, Parameters parameters);

// Helpers shared by the files that define shapes.
[[nodiscard]] inline Vector as_vector(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), Index(values.size()));
}
/// Key `side`: "outside" or "inside".
[[nodiscard]] Key obstacle_side_key(const std::string& doc);
/// Sign of the side: +1 outside, −1 inside.
[[nodiscard]] double obstacle_side(const Parameters& parameters);
/// Normalizes a vector of any length but zero; throws Error(invalid_input) that says which vector is zero.
[[nodiscard]] Vector unit_vector(const Vector& direction, const std::string& what);
/// Adds a problem if a vector of the case is zero.
void check_direction(const ParameterCheck& check, const Parameters& values, const std::string& key,
                     const std::string& meaning);
/// Throws Error(invalid_input) if a vector has two components: "a cylinder is in space; in two dimensions …".
void require_space(const Parameters& parameters, const std::string& key, const std::string& what,
                   const std::string& instead);
/// Returns the direction of a gradient of the gap, corrected along a displacement `relative_step` to be consistent with
/// the change of the gap over it:
///   gradient + (change − gradient·relative_step) relative_step/|relative_step|²,
/// or that of the gradient if the bracket is of the size of rounding errors, with a part of the correction up to twice
/// that size; for long steps see ObstacleShape::normal_of_step.
[[nodiscard]] SpaceVector corrected_normal(SpaceVector gradient, const SpaceVector& relative_step, double change,
                                           double rounding, const SpaceVector& at_start, const SpaceVector& at_end);
/// Eight rounding units of a number of this size.
[[nodiscard]] inline double eight_roundings(double size) { return 8.0 * std::numeric_limits<double>::epsilon() * size; }

}  // namespace ricochet
