#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/log.hpp"
#include "ricochet/base/point_sets.hpp"
#include "ricochet/base/rounded.hpp"
#include "ricochet/model/model_parts.hpp"

namespace ricochet {

/// Rounding of gaps, relative to the size of the body, above which they are useless.
constexpr double least_precision = 1e-6;

double node_spacing(const DisplacementSpace& space, const std::vector<Index>& facets) {
  double largest = 0.0;
  for (const Index facet : facets) {
    const auto [block, number] = locate_facet(space, facet);
    const CellBlock& cells = space.facets[block];
    const Index* nodes = cells.cell(number);
    Points positions(space.nodes.rows(), cells.nodes_per_cell);
    for (Index k = 0; k < positions.cols(); ++k) positions.col(k) = space.nodes.col(nodes[k]);
    largest = std::max(largest, largest_distance(positions) / space.degree);
  }
  return largest;
}

namespace {

/// Warns of obstacles that may pass between contact points: gaps are evaluated at these points only.
void warn_of_sharp_obstacle(const ContactPair& pair, const DisplacementSpace& space) {
  const double radius = pair.obstacle->least_radius();
  const double distance = node_spacing(space, pair.facets);
  if (!(radius < distance)) return;
  log::warning(
      fmt::format("contact of group \"{}\": the radius of curvature of obstacle \"{}\", {:.3g}, is smaller than the "
                  "distance between nodes of the group, {:.3g}: the obstacle can pass between them undetected, and the "
                  "force is wrong where it does not; use cells a third of the radius in size there",
                  pair.group, pair.obstacle_name, radius, distance));
}

/// Warns of a step so long that a body may pass the obstacle without touching it.
void warn_of_long_step(const Case& input, const ContactPair& pair, const Model& model) {
  const double radius = pair.obstacle->least_radius();
  if (!std::isfinite(radius) || radius <= 0.0) return;
  const int d = model.mesh.dimension;
  SpaceVector path = pair.obstacle->translation(input.time.step);
  if (const FreeMotion* const body = pair.obstacle->free_motion(); body != nullptr)
    path = input.time.step * model.initial.velocity.segment(body->centre_node() * d, d);
  double longest = 0.0;
  for (Index node = 0; node < model.space.cell_node_count(); ++node) {
    const SpaceVector moved = input.time.step * model.initial.velocity.segment(node * d, d) - path;
    longest = std::max(longest, moved.stableNorm());
  }
  if (!(longest > radius)) return;
  log::warning(fmt::format(
      "contact of group \"{}\": at the start the body moves by {:.3g} in a step relative to obstacle \"{}\", whose "
      "radius of curvature is {:.3g}: it can pass the obstacle without touching it; set time.step = {:.1g} or less",
      pair.group, longest, pair.obstacle_name, radius, rounded_down(0.1 * radius / longest * input.time.step, 1)));
}

/// Returns the largest rotation within a step, in rad, from a few hundred samples. It is summed over parts of a step,
/// as a full turn would otherwise count as rest.
double largest_rotation(const Obstacle& obstacle, Index dimension, const Case& input) {
  constexpr int most_steps = 500, parts = 16;
  const double h = input.time.step, steps = std::min(std::ceil(input.time.end / h), double(most_steps));
  double largest = 0.0;
  for (int k = 0; k < int(steps); ++k) {
    const double start = k * input.time.end / steps;
    double angle = 0.0;
    for (int part = 0; part < parts; ++part)
      angle += rotation_angle_between(obstacle.pose(start + part * h / parts),
                                      obstacle.pose(start + (part + 1) * h / parts), dimension);
    largest = std::max(largest, angle);
  }
  return largest;
}

/// Warns of fast rotation. Friction uses the motion of the material at the end of a step relative to the chord of the
/// step (motion_at), and its speed is tan(θ/2)/(θ/2) times the true one.
void warn_of_fast_rotation(const Case& input, const ContactPair& pair, Index dimension) {
  if (!pair.obstacle->rotates() || pair.obstacle->free_motion() != nullptr) return;
  constexpr double most = 0.3, advised = 0.25;
  const double angle = largest_rotation(*pair.obstacle, dimension, input);
  if (!(angle > most)) return;
  const std::string wrong =
      angle < 3.0 ? fmt::format("too large by {:.2g} %", 100.0 * (std::tan(0.5 * angle) / (0.5 * angle) - 1.0))
                  : "meaningless";
  log::warning(
      fmt::format("contact of group \"{}\": obstacle \"{}\" rotates by up to {:.3g} rad in a step, and the surface "
                  "speed that the step uses is {}; set time.step = {:.1g} or less{}",
                  pair.group, pair.obstacle_name, angle, wrong, rounded_down(advised / angle * input.time.step, 1),
                  pair.obstacle->shape().symmetry_axis().exists
                      ? ", or, if it rotates about its own axis, use rotation_rate instead of rotation"
                      : ""));
}

/// Refuses obstacles that are far away or have a distant centre: distances to them are differences of large numbers.
void refuse_lost_digits(const Case& input, const ContactPair& pair, const Model& model) {
  const double body = extent(model.space.nodes);
  const SpaceVector path = pair.obstacle->translation(input.time.end);
  double rounding = 0.0;
  for (Index node = 0; node < model.space.cell_node_count(); ++node)
    rounding = std::max(rounding, pair.obstacle->gap_rounding(model.space.nodes.col(node)));
  rounding += 8.0 * std::numeric_limits<double>::epsilon() * path.lpNorm<1>();
  if (rounding <= least_precision * body) return;
  refuse(input, "obstacle." + pair.obstacle_name,
         fmt::format("gaps to obstacle \"{}\" are rounded to {:.2g}, too much for a body of size {:.3g}: the obstacle "
                     "is too large, too far from the origin or moves too far; use a plane instead of a sphere of this "
                     "size, or move body and obstacle closer to the origin",
                     pair.obstacle_name, rounding, body));
}

}  // namespace

void check_obstacles(const Case& input, const Model& model) {
  for (const ContactPair& pair : model.contact_pairs) {
    if (pair.between_bodies()) continue;
    refuse_lost_digits(input, pair, model);
    warn_of_sharp_obstacle(pair, model.space);
    warn_of_long_step(input, pair, model);
    warn_of_fast_rotation(input, pair, model.space.nodes.rows());
  }
}

}  // namespace ricochet
