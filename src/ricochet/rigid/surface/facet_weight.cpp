#include "ricochet/rigid/surface/facet_weight.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;

/// Finds the interval in [0, 1] where the line a + s (b − a) is inside the circle of a squared radius about the origin.
/// Returns false if there is none.
bool part_inside(const Vector3& a, const Vector3& along, double square, double& first, double& last) {
  const double length = along.squaredNorm(), middle = -a.dot(along) / length;
  const double discriminant = middle * middle - (a.squaredNorm() - square) / length;
  if (!(length > 0.0) || !(discriminant > 0.0)) return false;
  const double half = std::sqrt(discriminant);
  first = std::clamp(middle - half, 0.0, 1.0);
  last = std::clamp(middle + half, 0.0, 1.0);
  return last > first;
}

/// Integrals of R² − r² and of y over the part of a plane figure inside a circle of radius R about the origin.
struct Part {
  double weight = 0.0;
  Vector3 moment = Vector3::Zero();
};

/// Adds the integrals over the triangle (0, a, b), with the sign of its orientation about the normal. Where the side is
/// outside the circle, the figure is a sector, with θ R⁴/4 and R³/3 times the difference of the unit vectors, rotated;
/// else it is a triangle.
void add_sector(const Vector3& a, const Vector3& b, const Vector3& normal, double square, Part& sum) {
  const auto add_arc = [&](const Vector3& from, const Vector3& to) {
    const double first = from.norm(), last = to.norm();
    if (!(first > 0.0) || !(last > 0.0)) return;
    sum.weight += 0.25 * square * square * std::atan2(normal.dot(from.cross(to)), from.dot(to));
    sum.moment += square * std::sqrt(square) / 3.0 * Vector3(to / last - from / first).cross(normal);
  };
  double first = 0.0, last = 0.0;
  const Vector3 along = b - a;
  if (!part_inside(a, along, square, first, last)) return add_arc(a, b);
  const Vector3 from = a + first * along, to = a + last * along;
  const double area = 0.5 * normal.dot(from.cross(to));
  sum.weight += area * (square - (from.squaredNorm() + from.dot(to) + to.squaredNorm()) / 6.0);
  sum.moment += area / 3.0 * (from + to);
  if (first > 0.0) add_arc(a, from);
  if (last < 1.0) add_arc(to, b);
}

/// Returns its area alone.
double area_of_sector(const Vector3& a, const Vector3& b, const Vector3& normal, double square) {
  const auto arc_area = [&](const Vector3& from, const Vector3& to) {
    return 0.5 * square * std::atan2(normal.dot(from.cross(to)), from.dot(to));
  };
  double first = 0.0, last = 0.0;
  const Vector3 along = b - a;
  if (!part_inside(a, along, square, first, last)) return arc_area(a, b);
  const Vector3 from = a + first * along, to = a + last * along;
  return 0.5 * normal.dot(from.cross(to)) + (first > 0.0 ? arc_area(a, from) : 0.0) +
         (last < 1.0 ? arc_area(to, b) : 0.0);
}

}  // namespace

FacetWeight weight_of_triangle(const std::array<Vector3, 3>& corners, const Vector3& normal, const Vector3& at,
                               double radius) {
  const double height = normal.dot(at - corners[0]);
  const double square = radius * radius - height * height;
  if (!(square > 0.0)) return {};
  const Vector3 foot = at - height * normal;
  Part sum;
  double area = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 a = corners[k] - foot, b = corners[(k + 1) % 3] - foot;
    add_sector(a, b, normal, square, sum);
    area += area_of_sector(a, b, normal, square);
  }
  if (!(sum.weight > 0.0)) return {};
  return {sum.weight, -2.0 * (area * height * normal - sum.moment)};
}

FacetWeight weight_of_segment(const Vector3& a, const Vector3& b, const Vector3& at, double radius) {
  double first = 0.0, last = 0.0;
  const Vector3 from = a - at, along = b - a;
  if (!part_inside(from, along, radius * radius, first, last)) return {};
  const auto integral = [&](double s) {
    return s * (radius * radius - from.squaredNorm() - s * from.dot(along) - s * s * along.squaredNorm() / 3.0);
  };
  const double length = along.norm();
  const Vector3 moment = (last - first) * (from + 0.5 * (first + last) * along);
  return {length * (integral(last) - integral(first)), 2.0 * length * moment};
}

}  // namespace ricochet
