#include "ricochet/simulation/monitor/obstacle_watch.hpp"

#include <algorithm>

namespace ricochet {

namespace {

/// Slope up to which a facet beyond a border counts as touching, too.
constexpr double flat_slope = 0.25;

Eigen::Vector3d in_space(const Vector& position) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  result.head(position.size()) = position;
  return result;
}

}  // namespace

ObstacleWatch::ObstacleWatch(const SemidiscreteProblem& problem, const std::vector<CellBlock>& cells,
                             const std::vector<CellFacet>& boundary, const std::vector<const Obstacle*>& obstacles,
                             const std::vector<double>& size)
    : problem_(problem),
      obstacles_(obstacles),
      size_(size),
      nodes_(obstacles.size()),
      deepest_(obstacles.size()),
      position_(problem.dimension) {
  for (const Obstacle* obstacle : obstacles) posed_.push_back(obstacle->at(0.0));
  for (std::size_t k = 0; k < obstacles.size(); ++k) find_nodes(cells, boundary, k);
}

void ObstacleWatch::find_nodes(const std::vector<CellBlock>& cells, const std::vector<CellFacet>& boundary,
                               std::size_t obstacle) {
  const ContactBoundary& contact = problem_.contact;
  std::vector<Index> contact_node(static_cast<std::size_t>(problem_.nodes.cols()), -1);
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    if (problem_.obstacles[std::size_t(contact.node_pair[i])] == obstacles_[obstacle])
      contact_node[std::size_t(contact.nodes[i])] = Index(i);
  }
  std::vector<Index>& alone = nodes_[obstacle];
  for (const CellFacet& facet : boundary) {
    RimFacet rim{obstacle, {}, {}};
    for (const Index node : nodes_of_facet(cells, facet)) {
      const Index entry = contact_node[std::size_t(node)];
      if (entry >= 0) rim.inside.push_back(entry);
      if (entry >= 0) continue;
      alone.push_back(node);
      if (!is_supported(obstacle, node)) rim.outside.push_back(node);
    }
    if (!rim.inside.empty() && !rim.outside.empty()) rim_.push_back(std::move(rim));
  }
  std::ranges::sort(alone);
  alone.erase(std::unique(alone.begin(), alone.end()), alone.end());
}

/// Tests for supports along the obstacle's normal: they then replace contact, and such a node is no contact node
/// although its facets belong to contact.
bool ObstacleWatch::is_supported(std::size_t obstacle, Index node) const {
  const Vector normal = obstacles_[obstacle]->normal(problem_.nodes.col(node));
  for (Index k = 0; k < normal.size(); ++k) {
    if (normal[k] != 0.0 && !problem_.supports.contains(node * normal.size() + k)) return false;
  }
  return true;
}

void ObstacleWatch::pose_obstacles(const State& state) {
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    if (obstacles_[k]->moves() || obstacles_[k]->free_motion() != nullptr)
      posed_[k] = obstacles_[k]->at(state.time, state.displacement);
  }
}

void ObstacleWatch::check(const State& state) {
  pose_obstacles(state);
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    for (const Index node : nodes_[k]) check_node(k, node, state);
  }
  for (const RimFacet& facet : rim_) check_rim(facet, state);
}

double ObstacleWatch::gap(std::size_t obstacle, Index node, const Vector& displacement) {
  const int d = problem_.dimension;
  for (int k = 0; k < d; ++k) position_[k] = problem_.nodes(k, node) + displacement[node * d + k];
  return posed_[obstacle].gap(position_);
}

void ObstacleWatch::check_start(const State& state) {
  pose_obstacles(state);
  std::vector<char> on_boundary(static_cast<std::size_t>(problem_.nodes.cols()), 0);
  for (const Index node : problem_.contact.nodes) on_boundary[std::size_t(node)] = 1;
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    for (Index node = 0; node < problem_.nodes.cols(); ++node) {
      if (problem_.is_of_free_body(node)) break;
      if (on_boundary[std::size_t(node)] == 0) check_node(k, node, state);
    }
  }
}

void ObstacleWatch::check_node(std::size_t obstacle, Index node, const State& state) {
  const double depth = -gap(obstacle, node, state.displacement);
  if (!(depth > deepest_[obstacle].depth) || depth <= rounding_of_depth * size_[std::size_t(node)] ||
      depth <= posed_[obstacle].gap_rounding(position_))
    return;
  deepest_[obstacle].enter(node, depth, state.time, in_space(position_));
}

bool ObstacleWatch::is_warned(int pair) const {
  return std::ranges::any_of(rims_, [pair](const RimContact& rim) { return rim.pair == pair; });
}

/// Uses the gap at nodes where no contact point is anchored.
bool ObstacleWatch::is_pressed(std::size_t obstacle, Index contact_node, const State& state) {
  const Index point = problem_.contact.own_point[std::size_t(contact_node)];
  if (point >= 0) return state.contact_status[std::size_t(point)] != ContactStatus::open;
  const Index node = problem_.contact.nodes[std::size_t(contact_node)];
  return gap(obstacle, node, state.displacement) <= rounding_of_depth * size_[std::size_t(node)];
}

void ObstacleWatch::check_rim(const RimFacet& facet, const State& state) {
  const ContactBoundary& contact = problem_.contact;
  const Vector& u = state.displacement;
  for (const Index entry : facet.inside) {
    const int pair = contact.node_pair[std::size_t(entry)];
    if (is_warned(pair) || !is_pressed(facet.obstacle, entry, state)) continue;
    const Index node = contact.nodes[std::size_t(entry)];
    const double here = gap(facet.obstacle, node, u);
    const Eigen::Vector3d from = in_space(position_);
    const bool is_flat = std::ranges::all_of(facet.outside, [&](Index other) {
      const double rise = gap(facet.obstacle, other, u) - here;
      return rise < flat_slope * (in_space(position_) - from).norm();
    });
    if (!is_flat) continue;
    (void)gap(facet.obstacle, node, u);
    rims_.push_back({pair, node, state.time, in_space(position_)});
  }
}

void ObstacleWatch::persist(const SnapshotVisitor& visit) {
  visit.numbers("deepest", deepest_);
  visit.list("rims", rims_);
}

}  // namespace ricochet
