#include "ricochet/rigid/obstacle_shape.hpp"

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"

namespace ricochet {

// The obstacles, each by the registration function of its own file. One line each, in the order of the documentation.
// clang-format off
#define RICOCHET_OBSTACLES(obstacle) \
  obstacle(plane_obstacle)           \
  obstacle(sphere_obstacle)          \
  obstacle(cylinder_obstacle)        \
  obstacle(torus_obstacle)           \
  obstacle(surface_obstacle)         \
  obstacle(implicit_obstacle)
// clang-format on

RICOCHET_DEFINE_REGISTRY(obstacle_registry, ObstacleConstructor, "obstacle type", RICOCHET_OBSTACLES)

std::unique_ptr<ObstacleShape> make_obstacle_shape(const std::string& type, Parameters parameters) {
  return obstacle_registry().find(type, parameters).type(parameters);
}

namespace {

/// Returns whether two unit vectors are within 60° of each other.
bool agree(const SpaceVector& a, const SpaceVector& b) { return a.dot(b) > 0.5; }

/// Returns the normal of a step so long that its midpoint is not representative: the normal at the end, unless a force
/// along it would create energy; then the direction perpendicular to `relative_step` that is nearest to it.
SpaceVector normal_of_long_step(const SpaceVector& relative_step, double change, const SpaceVector& at_start,
                                const SpaceVector& at_end) {
  if (at_end.dot(relative_step) * change >= 0.0) return at_end;
  const SpaceVector along = relative_step.normalized();
  constexpr double least = 0.1;
  for (const SpaceVector& normal : {at_end, at_start}) {
    const SpaceVector across = normal - normal.dot(along) * along;
    const double length = across.norm();
    if (length > least) return across / length;
  }
  Index axis = 0;
  along.cwiseAbs().minCoeff(&axis);
  const SpaceVector some = SpaceVector::Unit(along.size(), axis);
  return (some - some.dot(along) * along).normalized();
}

/// In rounding errors of gaps. A shorter displacement changes the work of a force by no more than this times rounding.
constexpr double least_step = 100.0;

}  // namespace

SpaceVector ObstacleShape::normal_at_middle(const SpaceVector& from, const SpaceVector& to) const {
  const SpaceVector middle = normal(0.5 * (from + to)), start = normal(from), end = normal(to);
  if (agree(middle, end) && agree(middle, start)) return middle;
  return normal_of_long_step(to - from, gap(to) - gap(from), start, end);
}

SpaceVector corrected_normal(SpaceVector gradient, const SpaceVector& relative_step, double change, double rounding,
                             const SpaceVector& at_start, const SpaceVector& at_end) {
  const double square = relative_step.squaredNorm(), missing = change - gradient.dot(relative_step);
  // Not switched at once beyond rounding: iterations in which a point hardly moves, and crosses the threshold back and
  // forth, would alternate between two normals. A displacement that is itself little more than rounding, as for a point
  // that sticks to a rotating obstacle, has no direction.
  const double part = std::clamp(std::abs(missing) / rounding - 1.0, 0.0, 1.0) *
                      std::clamp(std::sqrt(square) / (least_step * rounding) - 1.0, 0.0, 1.0);
  if (square > 0.0 && part > 0.0) gradient += part * missing / square * relative_step;
  const double length = gradient.norm();
  if (!(length > 0.0)) return normal_of_long_step(relative_step, change, at_start, at_end);
  const SpaceVector normal = gradient / length;
  return agree(normal, at_end) && agree(normal, at_start)
             ? normal
             : normal_of_long_step(relative_step, change, at_start, at_end);
}

SpaceVector ObstacleShape::normal_of_step(const SpaceVector& from, const SpaceVector& to) const {
  return corrected_normal(gradient(0.5 * (from + to)), to - from, gap(to) - gap(from),
                          gap_rounding(from) + gap_rounding(to), normal(from), normal(to));
}

/// Rescales the vector if the square of its length over- or underflows.
Vector unit_vector(const Vector& direction, const std::string& what) {
  const double length = direction.norm();
  if (length == 0.0 && direction.isZero(0.0)) throw Error(ErrorKind::invalid_input, what + " is zero");
  constexpr double smallest = 1e-150;
  if (std::isfinite(length) && length > smallest) return direction / length;
  return direction.stableNormalized();
}

void check_direction(const ParameterCheck& check, const Parameters& values, const std::string& key,
                     const std::string& meaning) {
  if (!check.is_usable(key)) return;
  const std::vector<double>& direction = values.vector(key);
  if (std::ranges::all_of(direction, [](double n) { return n == 0.0; }))
    check.add_problem(key, '"' + key + "\" must not be zero: it " + meaning);
}

void require_space(const Parameters& parameters, const std::string& key, const std::string& what,
                   const std::string& instead) {
  if (parameters.vector(key).size() != 3)
    throw Error(ErrorKind::invalid_input, what + " requires three dimensions; in two " + instead);
}

Key obstacle_side_key(const std::string& doc) {
  return choice_key("side", {"outside", "inside"}, {.default_value = "outside"}, doc);
}

double obstacle_side(const Parameters& parameters) { return parameters.text("side") == "inside" ? -1.0 : 1.0; }

}  // namespace ricochet
