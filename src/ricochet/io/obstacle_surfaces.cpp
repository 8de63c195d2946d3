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
    if (std::find(obstacles_.begin(), obstacles_.end(), obstacle) == obstacles_.end()) obstacles_.push_back(obstacle);
  }
  const Vector lowest = problem.nodes.rowwise().minCoeff(), highest = problem.nodes.rowwise().maxCoeff();
  centre_ = 0.5 * (lowest + highest);
  radius_ = reach * (highest - lowest).norm();
}

std::string ObstacleSurfaces::grid(double time) const {
  std::string cells, numbers, positions;
  Index points = 0, count = 0, corners = 2;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Points surface = obstacles_[i]->surface(centre_, radius_, time);
    corners = surface.rows() == 2 ? 2 : 4;
    for (Index k = 0; k < surface.cols(); ++k) {
      positions += fmt::format("{:.17g} {:.17g} {:.17g}\n", surface(0, k), surface(1, k),
                               surface.rows() == 3 ? surface(2, k) : 0.0);
    }
    // In the plane a line from point to point, in space one quadrilateral after the other.
    const Index step = corners == 2 ? 1 : 4;
    for (Index k = 0; k + corners <= surface.cols(); k += step) {
      for (Index c = 0; c < corners; ++c) cells += fmt::format("{} ", points + k + c);
      numbers += fmt::format("{} ", i);
      ++count;
    }
    points += surface.cols();
  }
  return fmt::format(
      "      <Grid Name=\"obstacles\" GridType=\"Uniform\">\n        <Time Value=\"{:.17g}\"/>\n"
      "        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\" NodesPerElement=\"{}\"><DataItem Format=\"XML\" "
      "NumberType=\"Int\" Precision=\"4\" Dimensions=\"{} {}\">{}</DataItem></Topology>\n"
      "        <Geometry GeometryType=\"XYZ\"><DataItem Format=\"XML\" NumberType=\"Float\" Precision=\"8\" "
      "Dimensions=\"{} 3\">\n{}</DataItem></Geometry>\n"
      "        <Attribute Name=\"obstacle\" AttributeType=\"Scalar\" Center=\"Cell\"><DataItem Format=\"XML\" "
      "NumberType=\"Int\" Precision=\"4\" Dimensions=\"{}\">{}</DataItem></Attribute>\n      </Grid>\n",
      time, corners == 2 ? "Polyline" : "Quadrilateral", count, corners, count, corners, cells, points, positions,
      count, numbers);
}

}  // namespace ricochet
