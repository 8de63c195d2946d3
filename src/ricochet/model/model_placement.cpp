#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ricochet/base/log.hpp"
#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Bodies that rest on an obstacle at the start of the run.
///
/// The body moves by s along a direction e until f(s) = min_i g(x_i + s e) equals the requested gap δ, where g is the
/// distance from the obstacle at t = 0 and x_i are the nodes of the boundary. A distance changes by no more than the
/// length of the path, so that
///   s ← s − (f(s) − δ)
/// never passes the first position with the gap δ, whether the body falls (f > δ) or is lifted out of the obstacle. The
/// error shrinks by the factor 1 − cos θ, where θ is the angle between e and the normal of the obstacle at the point of
/// contact: one iteration suffices on a plane.
namespace ricochet {

namespace {

/// A body that passes an obstacle comes no nearer: s then doubles with each iteration.
constexpr int most_iterations = 10'000;
/// In body sizes plus the initial gap: beyond this distance the body has missed the obstacle.
constexpr double out_of_reach = 1e3;

struct Nearest {
  double gap = std::numeric_limits<double>::infinity();
  SpaceVector position;
};

Nearest nearest_to(const Obstacle& obstacle, const Points& nodes, const SpaceVector& shift) {
  Nearest result;
  for (Index i = 0; i < nodes.cols(); ++i) {
    const SpaceVector position = nodes.col(i) + shift;
    const double gap = obstacle.gap(position);
    if (gap < result.gap) result = {gap, position};
  }
  return result;
}

Points boundary_nodes(const Mesh& mesh) {
  std::vector<Index> numbers;
  for (const CellFacet& facet : boundary_facets(mesh.cells)) {
    const std::vector<Index> nodes = nodes_of_facet(mesh.cells, facet);
    numbers.insert(numbers.end(), nodes.begin(), nodes.end());
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  Points nodes(mesh.dimension, Index(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) nodes.col(Index(i)) = mesh.nodes.col(numbers[i]);
  return nodes;
}

/// Returns the unit direction away from the obstacle: the normal of a plane, else against gravity or, without gravity,
/// the normal at the nearest node. Axisymmetric bodies stay on their axis.
SpaceVector direction_of(const Case& input, const std::string& key, const Obstacle& obstacle, const Nearest& nearest) {
  const std::vector<double>& gravity = input.load.gravity;
  const bool falls = std::ranges::any_of(gravity, [](double g) { return g != 0.0; });
  SpaceVector direction = obstacle.normal(nearest.position);
  if (!obstacle.shape().is_flat() && falls) direction = -vector_of(gravity).stableNormalized();
  if (!is_axisymmetric(input)) return direction;
  direction[0] = 0.0;
  if (direction.norm() == 0.0)
    refuse(input, key,
           "an axisymmetric body can move only along its axis, and the obstacle's normal is perpendicular to it");
  return direction.normalized();
}

}  // namespace

void rest_on_obstacle(const Case& input, const CaseMeshFile& file, const Model& model, Mesh& mesh) {
  const std::string key = file.section + ".rest_on";
  std::size_t number = 0;
  while (input.obstacles[number].name != file.rest_on) ++number;
  const Obstacle& obstacle = *model.obstacles[number];
  const Points nodes = boundary_nodes(mesh);
  Nearest nearest = nearest_to(obstacle, nodes, SpaceVector::Zero(mesh.dimension));
  const SpaceVector direction = direction_of(input, key, obstacle, nearest);
  const Vector sides = nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff();
  const double limit = out_of_reach * (sides.norm() + std::abs(nearest.gap) + file.rest_gap);
  double way = 0.0;
  for (int iteration = 0; std::abs(nearest.gap - file.rest_gap) > obstacle.gap_rounding(nearest.position);
       ++iteration) {
    const double before = way;
    way -= nearest.gap - file.rest_gap;
    if (way == before) break;
    if (!(std::abs(way) < limit) || iteration > most_iterations) {
      refuse(input, key,
             fmt::format("the body does not come to rest on obstacle \"{}\": moved along ({:.4g}), it misses the "
                         "obstacle; use \"move\" to set where it comes down",
                         file.rest_on, fmt::join(SpaceVector(way < 0.0 ? -direction : direction), ", ")));
    }
    nearest = nearest_to(obstacle, nodes, way * direction);
  }
  mesh.nodes.colwise() += way * direction;
  const SpaceVector shown = (way * direction).array() + 0.0;  // no "-0"
  log::info(fmt::format("{} is moved by ({:.6g}) to {} obstacle \"{}\"",
                        file.part.empty() ? "the body" : "part \"" + file.part + '"', fmt::join(shown, ", "),
                        file.rest_gap > 0.0 ? fmt::format("{:g} above", file.rest_gap) : "rest on", file.rest_on));
}

}  // namespace ricochet
