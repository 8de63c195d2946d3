#include "ricochet/problem/penetrating_points.hpp"

#include <algorithm>
#include <limits>

namespace ricochet {

namespace {

/// Number, in the whole body, of the first node of a point. It breaks ties between equally deep points in favour of the
/// lowest number, independent of the partition.
double number_of(const SemidiscreteProblem& problem, Index point) {
  Index lowest = std::numeric_limits<Index>::max();
  problem.contact.visit_own_nodes(
      point, [&](Index node, double) { lowest = std::min(lowest, Index(problem.ranks->number_of(node))); });
  return double(lowest);
}

/// Message of a rank to the others: number of points, then depth, number, pair and position of the deepest.
std::vector<double> message_of(const SemidiscreteProblem& problem, const Vector& gap,
                               const std::vector<Index>& points) {
  if (points.empty()) return {0.0};
  const Index deepest = *std::ranges::min_element(points, [&](Index a, Index b) {
    return gap[a] != gap[b] ? gap[a] < gap[b] : number_of(problem, a) < number_of(problem, b);
  });
  Vector position = Vector::Zero(problem.dimension);
  problem.contact.visit_own_nodes(deepest,
                                  [&](Index node, double weight) { position += weight * problem.nodes.col(node); });
  std::vector<double> message{double(points.size()), -gap[deepest], number_of(problem, deepest),
                              double(problem.contact.pair[std::size_t(deepest)])};
  message.insert(message.end(), position.begin(), position.end());
  return message;
}

}  // namespace

PenetratingPoints penetrating_points(const SemidiscreteProblem& problem, const Vector& gap, std::optional<int> pair,
                                     double depth) {
  PenetratingPoints inside;
  const ContactBoundary& contact = problem.contact;
  for (Index i = 0; i < gap.size(); ++i) {
    if (pair && contact.pair[std::size_t(i)] != *pair) continue;
    if (gap[i] < -std::max(depth, contact.rows->gap_rounding[i])) inside.points.push_back(i);
  }
  double number = 0.0;
  for (const std::vector<double>& message : problem.ranks->all_gather(message_of(problem, gap, inside.points))) {
    inside.count += Index(message[0]);
    if (message.size() == 1 || message[1] < inside.deepest) continue;
    if (message[1] == inside.deepest && message[2] > number) continue;
    inside.deepest = message[1];
    number = message[2];
    inside.pair = int(message[3]);
    inside.position = Eigen::Map<const Vector>(message.data() + 4, problem.dimension);
  }
  return inside;
}

PenetratingPoints initially_penetrating_points(const SemidiscreteProblem& problem, const Vector& displacement) {
  Vector gap;
  problem.gaps(displacement, 0.0, gap);
  return penetrating_points(problem, gap);
}

}  // namespace ricochet
