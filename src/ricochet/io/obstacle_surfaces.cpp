#include "ricochet/io/obstacle_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ricochet {

namespace {

/// The part that is shown reaches so many sizes of the body to each side.
constexpr double reach = 1.0;

}  // namespace

ObstacleSurfaces::ObstacleSurfaces(const SemidiscreteProblem& problem) {
  for (const Obstacle* obstacle : problem.obstacles) {
    const bool is_known = std::find(obstacles_.begin(), obstacles_.end(), obstacle) != obstacles_.end();
    if (obstacle != nullptr && !is_known) obstacles_.push_back(obstacle);
  }
  const Vector lowest = problem.nodes.rowwise().minCoeff(), highest = problem.nodes.rowwise().maxCoeff();
  const Vector centre = 0.5 * (lowest + highest);
  const double radius = reach * (highest - lowest).norm();
  std::string cells, numbers;
  Index points = 0, count = 0;
  int corners = 2;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const ObstacleSurface surface = obstacles_[i]->surface(centre, radius);
    corners = surface.corners();
    for (const int corner : surface.cells) cells += fmt::format("{} ", points + corner);
    const auto own = static_cast<Index>(surface.cells.size()) / corners;
    for (Index k = 0; k < own; ++k) numbers += fmt::format("{} ", i);
    count += own;
    points += surface.points.cols();
    points_.push_back(surface.points);
  }
  topology_ = fmt::format(
      "        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\" NodesPerElement=\"{}\"><DataItem Format=\"XML\" "
      "NumberType=\"Int\" Precision=\"4\" Dimensions=\"{} {}\">{}</DataItem></Topology>\n",
      corners == 2 ? "Polyline" : "Quadrilateral", count, corners, count, corners, cells);
  numbers_ = fmt::format(
      "        <Attribute Name=\"obstacle\" AttributeType=\"Scalar\" Center=\"Cell\"><DataItem Format=\"XML\" "
      "NumberType=\"Int\" Precision=\"4\" Dimensions=\"{}\">{}</DataItem></Attribute>\n",
      count, numbers);
}

std::string ObstacleSurfaces::grid(double time, const Vector& displacement) const {
  std::string positions;
  Index count = 0;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Points points = obstacles_[i]->surface_points(points_[i], time, displacement);
    count += points.cols();
    // Digits for a picture, in each frame again.
    for (const auto point : points.colwise())
      positions += fmt::format("{:.9g} {:.9g} {:.9g}\n", point[0], point[1], point.size() == 3 ? point[2] : 0.0);
  }
  return fmt::format(
      "      <Grid Name=\"obstacles\" GridType=\"Uniform\">\n        <Time Value=\"{:.17g}\"/>\n{}"
      "        <Geometry GeometryType=\"XYZ\"><DataItem Format=\"XML\" NumberType=\"Float\" Precision=\"8\" "
      "Dimensions=\"{} 3\">\n{}</DataItem></Geometry>\n{}      </Grid>\n",
      time, topology_, count, positions, numbers_);
}

}  // namespace ricochet
