#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/expression.hpp"
#include "ricochet/rigid/obstacle_shape.hpp"
#include "ricochet/rigid/surface/level_set_picture.hpp"

namespace ricochet {

namespace {

/// Step of the differences that approximate derivatives, relative to the size of the bodies: of fourth order, they are
/// accurate to 12 digits on a surface with the curvature of a body, and to 10 on one ten times as curved.
constexpr double step_of_size = 2e-4;
constexpr double digits_of_slopes = 4e-12;
/// Iterations of a search for the nearest point. Near the surface two to four suffice; searches that end without
/// converging are far away, where nothing depends on digits.
constexpr int max_iterations = 60;
/// Halvings of a step that does not come nearer.
constexpr int most_cuts = 30;
constexpr double least_part = 1e-6;  ///< smallest fraction of a step along the surface

/// Zero set of an expression φ(x, y, z), φ > 0 where bodies may be. The nearest point y of a position x is found by
/// Newton's method along ∇φ to the surface, followed by steps in its tangent plane towards x that are projected back to
/// the surface. The gap is n·(x − y) with n = ∇φ/|∇φ|, which is a distance for any size of ∇φ.
class Implicit final : public ObstacleShape {
 public:
  Implicit(const Parameters& parameters, double side)
      : value_(parameters.text("expression"), parameters.constants()), side_(side) {
    const std::string& text = value_.text();
    if (value_.depends_on_time())
      throw Error(
          ErrorKind::invalid_input,
          fmt::format("the expression \"{}\" depends on t; set the obstacle's motion by \"motion\" and \"rotation\"",
                      text));
    if (!value_.depends_on_position())
      throw Error(ErrorKind::invalid_input, fmt::format("the expression \"{}\" does not depend on the position", text));
  }

  [[nodiscard]] double gap(const SpaceVector& position) const override { return foot_of(position).gap; }
  [[nodiscard]] SpaceVector normal(const SpaceVector& position) const override { return foot_of(position).normal; }
  [[nodiscard]] double gap_rounding(const SpaceVector& position) const override {
    return eight_roundings(4.0 * (position.lpNorm<1>() + size_));
  }
  [[nodiscard]] SpaceVector centre() const override { return {}; }
  void fit(const ContactScale& scale) override {
    if (scale.body_size > 0.0) size_ = scale.body_size;
  }
  [[nodiscard]] ObstacleSurface surface(const Vector& centre, double radius) const override {
    const SpaceVector middle = SpaceVector(centre) - gap(centre) * normal(centre);
    return picture_of_level_set([&](const SpaceVector& at) { return side_ * value_at(at); }, middle, radius);
  }

 private:
  struct Foot {
    SpaceVector normal;
    double gap;
  };
  struct Slope {
    double value;
    SpaceVector gradient;
    double variation;  ///< of the values from which the gradient is computed
  };
  [[nodiscard]] double value_at(const SpaceVector& at) const {
    return value_(at[0], at[1], at.size() == 3 ? at[2] : 0.0, 0.0);
  }
  [[nodiscard]] Slope slope_at(SpaceVector at) const {
    Slope slope{value_at(at), SpaceVector::Zero(at.size()), 0.0};
    const double step = step_of_size * size_;
    for (Index k = 0; k < at.size(); ++k) {
      const double here = at[k];
      const auto value = [&](double steps) {
        at[k] = here + steps * step;
        return value_at(at);
      };
      const double right = value(1.0), left = value(-1.0);
      slope.gradient[k] = (8.0 * (right - left) - (value(2.0) - value(-2.0))) / (12.0 * step);
      slope.variation = std::max({slope.variation, std::abs(right - slope.value), std::abs(left - slope.value)});
      at[k] = here;
    }
    return slope;
  }
  [[noreturn]] void refuse(const SpaceVector& at) const {
    std::string coordinates;
    for (const double x : at) coordinates += fmt::format("{}{:.6g}", coordinates.empty() ? "" : ", ", x);
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("the gradient of the expression \"{}\" vanishes at ({}): there is no normal there; use an "
                    "expression that changes its sign across the surface with a nonzero slope, such as a distance",
                    value_.text(), coordinates));
  }

  /// Moves a point along the gradient to the surface and computes the slope there; returns false if it does not
  /// converge.
  bool project(SpaceVector& at, Slope& slope) const {
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      slope = slope_at(at);
      const double square = slope.gradient.squaredNorm();
      constexpr double least_slope = 1e-2;
      if (!(std::sqrt(square) * step_of_size * size_ > least_slope * slope.variation)) refuse(at);
      SpaceVector step = (slope.value / square) * slope.gradient;
      if (step.norm() <= eight_roundings(at.lpNorm<1>() + size_)) return true;
      // If the slope is small, as in the middle of a thin body, the Newton step is much too long.
      for (int cut = 0; cut < most_cuts && !(std::abs(value_at(at - step)) < std::abs(slope.value)); ++cut) step *= 0.5;
      at -= step;
    }
    return false;
  }

  /// Moves from the projection along the surface towards the position as long as that comes nearer, with the step
  /// lengths of J. Barzilai and J. M. Borwein, IMA J. Numer. Anal. 8 (1988) 141–148, which adapt to its curvature.
  [[nodiscard]] Foot foot_of(const SpaceVector& position) const {
    SpaceVector foot = position;
    Slope slope{};
    if (!project(foot, slope)) return first_tangent_plane(position);
    const double rounding = eight_roundings(position.lpNorm<1>() + size_);
    const auto along_surface = [&](const SpaceVector& from, const Slope& there) {
      const SpaceVector normal = there.gradient.normalized(), away = position - from;
      return SpaceVector(away - normal.dot(away) * normal);
    };
    SpaceVector along = along_surface(foot, slope);
    double part = 1.0;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      if (along.norm() <= std::max(rounding, digits_of_slopes * (position - foot).norm())) break;
      SpaceVector next;
      Slope there{};
      const double before = (position - foot).squaredNorm();
      const auto is_nearer = [&] {
        next = foot + part * along;
        return project(next, there) && (position - next).squaredNorm() < before;
      };
      while (part > least_part && !is_nearer()) part *= 0.25;
      if (part <= least_part) break;
      const SpaceVector way = next - foot, change = along - along_surface(next, there);
      const double bend = way.dot(change);
      part = bend > 0.0 ? std::clamp(way.squaredNorm() / bend, 1e-3, 1e3) : 1.0;
      foot = next;
      slope = there;
      along = along_surface(foot, slope);
    }
    const SpaceVector normal = slope.gradient.normalized();
    return {side_ * normal, side_ * normal.dot(position - foot)};
  }
  /// Approximates the gap if no path leads to the surface: its sign is right, and its size approximate.
  [[nodiscard]] Foot first_tangent_plane(const SpaceVector& position) const {
    const Slope slope = slope_at(position);
    const double steepness = slope.gradient.norm();
    if (!(steepness > 0.0)) refuse(position);
    return {side_ / steepness * slope.gradient, side_ * slope.value / steepness};
  }

  Expression value_;
  double side_;
  double size_ = 1.0;
};

std::vector<Key> implicit_keys() {
  return {
      typed_key("expression", KeyType::text, "", required(),
                "An expression in x, y and z that is zero on the surface, positive outside the obstacle and negative "
                "inside, with a nonzero slope where it is zero: \"sqrt(x^2 + y^2) - 0.5 - 0.1*z\"."),
      obstacle_side_key("Side of the bodies: \"outside\", where the expression is positive, or \"inside\".")};
}

void check_implicit(const ParameterCheck& check, const Parameters& values) {
  if (!check.is_usable("expression")) return;
  try {
    static_cast<void>(Implicit(values, 1.0));
  } catch (const Error& problem) {
    check.add_problem("expression", problem.what());
  }
}

}  // namespace

ObstacleRegistration implicit_obstacle() {
  const auto make = [](const Parameters& parameters) {
    return std::make_unique<Implicit>(parameters, obstacle_side(parameters));
  };
  return {"implicit", make, implicit_keys(), {}, check_implicit};
}

}  // namespace ricochet
