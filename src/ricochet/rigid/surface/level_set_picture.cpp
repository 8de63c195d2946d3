#include "ricochet/rigid/surface/level_set_picture.hpp"

#include <Eigen/Geometry>
#include <array>
#include <map>

namespace ricochet {

namespace {

constexpr int squares = 160, cubes = 32;

/// Cuts the simplices of a grid in which the function changes its sign.
class LevelSet {
 public:
  LevelSet(const std::function<double(const SpaceVector&)>& function, const SpaceVector& middle, double half_width)
      : d_(middle.size()),
        cells_(d_ == 2 ? squares : cubes),
        low_(middle.array() - half_width),
        width_(2.0 * half_width / double(cells_)) {
    const Index wide = cells_ + 1;
    values_.resize(std::size_t(d_ == 2 ? wide * wide : wide * wide * wide));
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = function(position(long(i)));
  }

  [[nodiscard]] ObstacleSurface cut() {
    const long wide = cells_ + 1;
    for (long k = 0; k < (d_ == 2 ? 1 : cells_); ++k) {
      for (long j = 0; j < cells_; ++j) {
        for (long i = 0; i < cells_; ++i) {
          const long first = i + wide * (j + wide * k);
          d_ == 2 ? cut_square(first, wide) : cut_cube(first, wide);
        }
      }
    }
    surface_.points.resize(d_, Index(points_.size()));
    for (std::size_t k = 0; k < points_.size(); ++k) surface_.points.col(Index(k)) = points_[k];
    return surface_;
  }

 private:
  [[nodiscard]] SpaceVector position(long point) const {
    SpaceVector result = low_;
    const long wide = cells_ + 1;
    for (Index k = 0; k < d_; ++k, point /= wide) result[k] += width_ * double(point % wide);
    return result;
  }
  [[nodiscard]] double value(long point) const { return values_[std::size_t(point)]; }
  [[nodiscard]] bool is_inside(long point) const { return value(point) < 0.0; }
  int crossing(long a, long b) {
    if (a > b) std::swap(a, b);
    const auto [entry, added] = crossings_.try_emplace({a, b}, int(points_.size()));
    if (added) {
      const double part = value(a) / (value(a) - value(b));
      points_.push_back((1.0 - part) * position(a) + part * position(b));
    }
    return entry->second;
  }
  [[nodiscard]] const SpaceVector& point(int number) const { return points_[std::size_t(number)]; }

  void cut_square(long first, long wide) {
    cut_triangle({first, first + 1, first + wide + 1});
    cut_triangle({first, first + wide + 1, first + wide});
  }
  /// Corners are counterclockwise, and the line has the inside corners on its right.
  void cut_triangle(const std::array<long, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const long alone = corners[k], next = corners[(k + 1) % 3], last = corners[(k + 2) % 3];
      if (is_inside(alone) == is_inside(next) || is_inside(alone) == is_inside(last)) continue;
      const int a = crossing(alone, next), b = crossing(alone, last);
      if (is_inside(alone)) surface_.cells.insert(surface_.cells.end(), {b, a});
      if (!is_inside(alone)) surface_.cells.insert(surface_.cells.end(), {a, b});
    }
  }

  /// Cuts a cube into six tetrahedra around a diagonal.
  void cut_cube(long first, long wide) {
    const std::array<long, 3> along{1, wide, wide * wide};
    constexpr std::array<std::array<std::size_t, 3>, 6> orders{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    for (const auto& order : orders) {
      const long second = first + along[order[0]], third = second + along[order[1]], last = third + along[order[2]];
      cut_tetrahedron({first, second, third, last});
    }
  }
  void cut_tetrahedron(const std::array<long, 4>& corners) {
    std::array<long, 4> inside{}, outside{};
    std::size_t in = 0, out = 0;
    for (const long corner : corners) (is_inside(corner) ? inside[in++] : outside[out++]) = corner;
    if (in == 0 || out == 0) return;
    const SpaceVector outwards = position(outside[0]) - position(inside[0]);
    if (in == 2) {
      add_face(crossing(inside[0], outside[0]), crossing(inside[0], outside[1]), crossing(inside[1], outside[1]),
               crossing(inside[1], outside[0]), outwards);
      return;
    }
    const long alone = in == 1 ? inside[0] : outside[0];
    const std::array<long, 4>& others = in == 1 ? outside : inside;
    const int last = crossing(alone, others[2]);
    add_face(crossing(alone, others[0]), crossing(alone, others[1]), last, last, outwards);
  }
  void add_face(int a, int b, int c, int d, const SpaceVector& outwards) {
    const Eigen::Vector3d first = point(b) - point(a), second = point(c) - point(a);
    if (first.cross(second).dot(Eigen::Vector3d(outwards)) < 0.0) {
      std::swap(a, c);
      if (d == a) d = c;
    }
    surface_.cells.insert(surface_.cells.end(), {a, b, c, d});
  }

  Index d_;
  long cells_;
  SpaceVector low_;
  double width_;
  std::vector<double> values_;
  std::map<std::pair<long, long>, int> crossings_;
  std::vector<SpaceVector> points_;
  ObstacleSurface surface_;
};

}  // namespace

ObstacleSurface picture_of_level_set(const std::function<double(const SpaceVector&)>& function,
                                     const SpaceVector& middle, double half_width) {
  return LevelSet(function, middle, half_width).cut();
}

}  // namespace ricochet
