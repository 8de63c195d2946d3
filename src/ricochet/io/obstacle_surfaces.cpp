#include "ricochet/io/obstacle_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ricochet {

/// Extent of the displayed part to each side, in sizes of the body.
constexpr double reach = 1.0;

ObstacleSurfaces::ObstacleSurfaces(const SemidiscreteProblem& problem) {
  for (const Obstacle* obstacle : problem.obstacles) {
    const bool is_known = std::ranges::find(obstacles_, obstacle) != obstacles_.end();
    if (obstacle != nullptr && !is_known) obstacles_.push_back(obstacle);
  }
  const Vector lowest = problem.nodes.rowwise().minCoeff(), highest = problem.nodes.rowwise().maxCoeff();
  const Vector centre = 0.5 * (lowest + highest);
  const double radius = reach * (highest - lowest).norm();
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const ObstacleSurface surface = obstacles_[i]->surface(centre, radius);
    corners_ = surface.corners();
    for (const int corner : surface.cells) cells_.push_back(int(point_count_) + corner);
    numbers_.resize(cells_.size() / std::size_t(corners_), int(i));
    point_count_ += surface.points.cols();
    points_.push_back(surface.points);
  }
  topology_text_ = fmt::format(
      "        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\" NodesPerElement=\"{}\"><DataItem Format=\"XML\" "
      "NumberType=\"Int\" Precision=\"4\" Dimensions=\"{} {}\">{} </DataItem></Topology>\n",
      corners_ == 2 ? "Polyline" : "Quadrilateral", numbers_.size(), corners_, numbers_.size(), corners_,
      fmt::join(cells_, " "));
  numbers_text_ = fmt::format(
      "        <Attribute Name=\"obstacle\" AttributeType=\"Scalar\" Center=\"Cell\"><DataItem Format=\"XML\" "
      "NumberType=\"Int\" Precision=\"4\" Dimensions=\"{}\">{} </DataItem></Attribute>\n",
      numbers_.size(), fmt::join(numbers_, " "));
}

std::vector<double> ObstacleSurfaces::positions(double time, const Vector& displacement) const {
  std::vector<double> result;
  result.reserve(std::size_t(3 * point_count_));
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Points points = obstacles_[i]->surface_points(points_[i], time, displacement);
    for (const auto point : points.colwise())
      result.insert(result.end(), {point[0], point[1], point.size() == 3 ? point[2] : 0.0});
  }
  return result;
}

std::string ObstacleSurfaces::grid(double time, const Vector& displacement) const {
  const std::vector<double> all = positions(time, displacement);
  std::string text;
  // Reduced precision for display, as positions are repeated in each frame.
  for (std::size_t i = 0; i < all.size(); i += 3)
    text += fmt::format("{:.9g} {:.9g} {:.9g}\n", all[i], all[i + 1], all[i + 2]);
  return fmt::format(
      "      <Grid Name=\"obstacles\" GridType=\"Uniform\">\n        <Time Value=\"{:.17g}\"/>\n{}"
      "        <Geometry GeometryType=\"XYZ\"><DataItem Format=\"XML\" NumberType=\"Float\" Precision=\"8\" "
      "Dimensions=\"{} 3\">\n{}</DataItem></Geometry>\n{}      </Grid>\n",
      time, topology_text_, point_count_, text, numbers_text_);
}

}  // namespace ricochet
