#include "ricochet/simulation/monitor/tunnelling_watch.hpp"

#include <algorithm>

namespace ricochet {

namespace {

/// Largest depth on a straight path between two positions in the frame of the shape.
double deepest_between(const ObstacleShape& shape, const SpaceVector& from, const SpaceVector& to) {
  constexpr int pieces = 16;
  double depth = 0.0;
  for (int k = 1; k < pieces; ++k) {
    const double part = double(k) / pieces;
    depth = std::max(depth, -shape.gap((1.0 - part) * from + part * to));
  }
  return depth;
}

/// Depth of a node that passes through; 0 otherwise. `gap_before` may be a lower bound.
double depth_of_passage(const ObstacleShape& shape, const SpaceVector& before, double gap_before,
                        const SpaceVector& now, double gap) {
  if ((now - before).norm() <= std::max(gap, 0.0) + std::max(gap_before, 0.0)) return 0.0;
  if (!(shape.normal(before).dot(shape.normal(now)) < 0.0)) return 0.0;
  const double depth = deepest_between(shape, before, now);
  return depth <= shape.gap_rounding(now) || gap < -depth || gap_before < -depth ? 0.0 : depth;
}

}  // namespace

TunnellingWatch::TunnellingWatch(const SemidiscreteProblem& problem, std::vector<Index> nodes,
                                 const std::vector<const Obstacle*>& obstacles, Of of)
    : problem_(problem),
      nodes_(std::move(nodes)),
      of_(of),
      obstacles_(obstacles),
      previous_(obstacles.size()),
      passages_(obstacles.size()) {}

void TunnellingWatch::check(const State& state) {
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    // A node on the other side of a plane is inside.
    if (!obstacles_[k]->shape().is_flat()) check_obstacle(k, state);
  }
}

void TunnellingWatch::check_obstacle(std::size_t obstacle, const State& state) {
  const ObstacleShape& shape = obstacles_[obstacle]->shape();
  const PosedObstacle posed = obstacles_[obstacle]->at(state.time, state.displacement);
  Previous& previous = previous_[obstacle];
  const Index d = problem_.dimension;
  const bool is_first = previous.gaps.size() == 0;
  if (is_first) {
    previous.positions.resize(d, Index(nodes_.size()));
    previous.gaps.resize(previous.positions.cols());
  }
  for (Index i = 0; i < previous.positions.cols(); ++i) {
    const Index node = nodes_[std::size_t(i)];
    const SpaceVector position = position_of(node, state);
    const SpaceVector now = posed.pose().to_body_frame(position);
    const SpaceVector before = is_first ? now : SpaceVector(previous.positions.col(i));
    const double way = (now - before).norm();
    previous.positions.col(i) = now;
    if (!is_first && previous.gaps[i] > way) {
      previous.gaps[i] -= way;
      continue;
    }
    const double gap = shape.gap(now), gap_before = previous.gaps[i];
    previous.gaps[i] = gap;
    if (is_first || passages_[obstacle].found()) continue;
    const double depth = depth_of_passage(shape, before, gap_before, now, gap);
    if (!(depth > 0.0)) continue;
    Eigen::Vector3d in_space = Eigen::Vector3d::Zero();
    in_space.head(d) = position;
    passages_[obstacle].enter(node, depth, state.time, in_space);
  }
}

SpaceVector TunnellingWatch::position_of(Index node, const State& state) const {
  const Index d = problem_.dimension;
  const auto at = [&](Index one) -> SpaceVector {
    return problem_.nodes.col(one) + state.displacement.segment(one * d, d);
  };
  if (of_ == Of::nodes) return at(node);
  SpaceVector result = SpaceVector::Zero(d);
  problem_.contact.visit_own_nodes(node, [&](Index one, double weight) { result += weight * at(one); });
  return result;
}

bool TunnellingWatch::any_tunnels(const State& state, double time) const {
  for (std::size_t k = 0; k < obstacles_.size(); ++k) {
    const Previous& previous = previous_[k];
    if (obstacles_[k]->shape().is_flat() || previous.gaps.size() == 0) continue;
    const ObstacleShape& shape = obstacles_[k]->shape();
    const PosedObstacle posed = obstacles_[k]->at(time, state.displacement);
    for (Index i = 0; i < previous.positions.cols(); ++i) {
      const SpaceVector now = posed.pose().to_body_frame(position_of(nodes_[std::size_t(i)], state));
      const SpaceVector before = previous.positions.col(i);
      if (previous.gaps[i] > (now - before).norm()) continue;
      if (depth_of_passage(shape, before, previous.gaps[i], now, shape.gap(now)) > 0.0) return true;
    }
  }
  return false;
}

void TunnellingWatch::persist(const SnapshotVisitor& visit) {
  for (std::size_t k = 0; k < previous_.size(); ++k) {
    auto& [positions, gaps] = previous_[k];
    const SnapshotVisitor each = visit.part(k);
    each("gaps", gaps, Index(nodes_.size()), 0);
    each("places", positions, problem_.dimension, gaps.size(), gaps.size());
    each.numbers("passage", passages_[k]);
  }
}

}  // namespace ricochet
