#include "ricochet/contact/surface/facet_weight.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

using Three = Eigen::Vector3d;

/// Where the line a + s (b − a) is inside of the circle of a squared radius about the origin, cut to [0, 1]. False:
/// nowhere.
bool part_inside(const Three& a, const Three& along, double square, double& first, double& last) {
  const double length = along.squaredNorm(), middle = -a.dot(along) / length;
  const double discriminant = middle * middle - (a.squaredNorm() - square) / length;
  if (!(length > 0.0) || !(discriminant > 0.0)) return false;
  const double half = std::sqrt(discriminant);
  first = std::clamp(middle - half, 0.0, 1.0);
  last = std::clamp(middle + half, 0.0, 1.0);
  return last > first;
}

/// ∫ (R² − r²) over the part of the triangle (0, a, b) inside of the circle, signed by its turn about the normal. Where
/// the side is outside of the circle it is a sector, θ R⁴/4; else a triangle.
double sector(const Three& a, const Three& b, const Three& normal, double square) {
  const auto turn = [&](const Three& from, const Three& to) {
    return 0.25 * square * square * std::atan2(normal.dot(from.cross(to)), from.dot(to));
  };
  double first = 0.0, last = 0.0;
  const Three along = b - a;
  if (!part_inside(a, along, square, first, last)) return turn(a, b);
  const Three from = a + first * along, to = a + last * along;
  const double area = 0.5 * normal.dot(from.cross(to));
  double sum = area * (square - (from.squaredNorm() + from.dot(to) + to.squaredNorm()) / 6.0);
  if (first > 0.0) sum += turn(a, from);
  if (last < 1.0) sum += turn(to, b);
  return sum;
}

}  // namespace

double weight_of_triangle(const std::array<Three, 3>& corners, const Three& normal, const Three& at, double radius) {
  const double height = normal.dot(at - corners[0]);
  const double square = radius * radius - height * height;
  if (!(square > 0.0)) return 0.0;
  const Three foot = at - height * normal;
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) sum += sector(corners[k] - foot, corners[(k + 1) % 3] - foot, normal, square);
  return std::max(sum, 0.0);
}

double weight_of_segment(const Three& a, const Three& b, const Three& at, double radius) {
  double first = 0.0, last = 0.0;
  const Three from = a - at, along = b - a;
  if (!part_inside(from, along, radius * radius, first, last)) return 0.0;
  const auto integral = [&](double s) {
    return s * (radius * radius - from.squaredNorm() - s * from.dot(along) - s * s * along.squaredNorm() / 3.0);
  };
  return along.norm() * (integral(last) - integral(first));
}

}  // namespace ricochet
