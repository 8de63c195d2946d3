#include "ricochet/solver/contact/cone_formulation.hpp"

namespace ricochet {

std::string refuse_bounds(const ContactSystem& system) {
  for (const ContactPoint& point : system.points()) {
    if (point.bound > 0.0)
      return "friction has a bound: with it the law is not that of a cone, on which this solver works";
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

double weighted_product(const ContactSystem& system, const Vector& x, const Vector& y) {
  double sum = 0.0;
  for (const ContactPoint& point : system.points()) sum += point.diagonal * padded(point, x).dot(padded(point, y));
  return sum;
}

}  // namespace ricochet
