#include "ricochet/problem/points_inside.hpp"

#include <algorithm>

namespace ricochet {

namespace {

/// What a rank tells the others: how many there are, then depth, pair and place of the deepest.
std::vector<double> told_of(const SemidiscreteProblem& problem, const Vector& gap, const std::vector<Index>& points) {
  std::vector<double> told{static_cast<double>(points.size())};
  if (points.empty()) return told;
  const Index deepest =
      *std::min_element(points.begin(), points.end(), [&](Index a, Index b) { return gap[a] < gap[b]; });
  Vector place = Vector::Zero(problem.dimension);
  problem.contact.visit_own_nodes(deepest,
                                  [&](Index node, double weight) { place += weight * problem.nodes.col(node); });
  told.push_back(-gap[deepest]);
  told.push_back(problem.contact.pair[static_cast<std::size_t>(deepest)]);
  told.insert(told.end(), place.begin(), place.end());
  return told;
}

}  // namespace

PointsInside points_inside(const SemidiscreteProblem& problem, const Vector& gap, std::optional<int> pair,
                           double depth) {
  PointsInside inside;
  const ContactBoundary& contact = problem.contact;
  for (Index i = 0; i < gap.size(); ++i) {
    if (pair && contact.pair[static_cast<std::size_t>(i)] != *pair) continue;
    if (gap[i] < -std::max(depth, contact.rows->gap_rounding[i])) inside.points.push_back(i);
  }
  for (const std::vector<double>& told : problem.ranks->of_all(told_of(problem, gap, inside.points))) {
    inside.count += static_cast<Index>(told[0]);
    if (told.size() == 1 || told[1] <= inside.deepest) continue;
    inside.deepest = told[1];
    inside.pair = static_cast<int>(told[2]);
    inside.place = Eigen::Map<const Vector>(told.data() + 3, problem.dimension);
  }
  return inside;
}

PointsInside points_inside_at_start(const SemidiscreteProblem& problem, const Vector& displacement) {
  Vector gap;
  problem.gaps(displacement, 0.0, gap);
  return points_inside(problem, gap);
}

}  // namespace ricochet
