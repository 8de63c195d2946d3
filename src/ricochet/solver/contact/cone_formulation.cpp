#include "ricochet/solver/contact/cone_formulation.hpp"

#include <cmath>

namespace ricochet {

std::string refuse_bounds(const ContactSystem& system) {
  for (const ContactPoint& point : system.points()) {
    if (point.bound > 0.0)
      return "friction has a bound: the friction law is then not that of a cone, which this solver requires";
  }
  return "";
}

bool open_points(const ContactSystem& system, ContactIterate& iterate) {
  bool changed = false;
  for (const ContactPoint& point : system.points()) {
    const PaddedVector r = padded(point, iterate.reaction);
    if (r.isZero(0.0)) continue;
    const PaddedVector step = de_saxce(point, padded(point, iterate.motion)) / point.diagonal;
    if (!project(point, PaddedVector(r - step)).isZero(0.0)) continue;
    enter(point, PaddedVector::Zero(), iterate.reaction);
    changed = true;
  }
  return changed;
}

void FirstOrderVerdict::start(const ContactSystem& system, double tolerance, const ContactIterate& current) {
  best_ = current;
  best_residual_ = system.residual(current);
  tolerance_ = tolerance;
}

bool FirstOrderVerdict::is_solved(const ContactSystem& system, int k, double residual, ContactIterate& current) {
  if (residual > tolerance_ * system.data() && k % interval != 0) return false;
  system.evaluate(current);
  if (system.is_solved(current, tolerance_)) return true;
  if (residual < best_residual_) {
    best_residual_ = residual;
    best_ = current;
  }
  return false;
}

bool FirstOrderVerdict::finish(const ContactSystem& system, ContactIterate& current) const {
  const double residual = system.residual(current);
  const bool finite = std::isfinite(residual);
  if (!(finite && residual < best_residual_)) current = best_;
  system.evaluate(current);
  return finite;
}

double weighted_product(const ContactSystem& system, const Vector& x, const Vector& y) {
  double sum = 0.0;
  for (const ContactPoint& point : system.points()) sum += point.diagonal * padded(point, x).dot(padded(point, y));
  return sum;
}

}  // namespace ricochet
