#include "ricochet/simulation/monitor/body_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/simulation/monitor/surface_pieces.hpp"

namespace ricochet {

/// Relative motion between two checks, in edge lengths.
constexpr double motion_between_checks = 0.25;
/// Factor on this motion for bodies whose overlap has been reported: then only its depth is of interest.
constexpr double resolution_of_found = 4.0;

BodyWatch::BodyWatch(const Points& positions, const std::vector<CellBlock>& cells,
                     const std::vector<CellFacet>& boundary, const ConnectedBodies& bodies,
                     const std::vector<double>& size, const std::vector<ContactNodeAllowance>& node_allowances)
    : positions_(positions) {
  if (bodies.count < 2) return;
  std::vector<std::vector<CellFacet>> facets(static_cast<std::size_t>(bodies.count));
  for (const CellFacet& facet : boundary) {
    const Index node = cells[facet.block].cell(facet.cell)[0];
    facets[std::size_t(bodies.of_node[std::size_t(node)])].push_back(facet);
  }
  resolution_ = std::numeric_limits<double>::infinity();
  for (const std::vector<CellFacet>& own : facets) {
    surfaces_.emplace_back(positions, surface_pieces(positions, cells, own));
    const std::vector<Index>& nodes = surfaces_.back().nodes();
    size_.push_back(size[std::size_t(nodes.front())]);
    resolution_ = std::min(resolution_, motion_between_checks * surfaces_.back().edge_length());
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
  }
  last_displacement_.setZero(Index(nodes_.size()) * positions.rows());
  set_allowances(node_allowances, bodies);
}

void BodyWatch::set_allowances(const std::vector<ContactNodeAllowance>& node_allowances,
                               const ConnectedBodies& bodies) {
  for (const ContactNodeAllowance& one : node_allowances) {
    const int of = bodies.of_node[std::size_t(one.node)];
    const std::vector<Index>& nodes = surfaces_[std::size_t(of)].nodes();
    const auto at = std::ranges::lower_bound(nodes, one.node);
    if (at == nodes.end() || *at != one.node) continue;
    std::vector<Allowance>& list = allowances_[{of, one.other}];
    list.resize(nodes.size());
    Allowance& entry = list[std::size_t(at - nodes.begin())];
    if (one.allowance > entry.allowance) entry = {one.allowance, one.contact, one.entry};
  }
}

/// Gaps of nodes that face nothing are NaN.
double BodyWatch::Allowance::depth_allowed(const Vector& gap) const {
  return allowance + (entry >= 0 && gap[entry] < 0.0 ? -gap[entry] : 0.0);
}

void BodyWatch::check(const Vector& displacement, double time, bool now, const NodeGaps& gaps) {
  if (surfaces_.empty()) return;
  const bool due = checks_ == 0 || is_due(displacement);
  if (!due && !now) return;
  for (BodySurface& surface : surfaces_) surface.move(positions_, displacement);
  gap_ = allowances_.empty() ? nullptr : &gaps();
  double apart = std::numeric_limits<double>::infinity();
  const int count = int(surfaces_.size());
  for (int first = 0; first < count; ++first) {
    for (int second = first + 1; second < count; ++second) {
      const double between = check_pair(first, second, time);
      apart =
          std::min(apart, has_found(first, second) ? std::max(between, resolution_of_found * resolution_) : between);
    }
  }
  if (!due) return;
  ++checks_;
  const Index d = positions_.rows();
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    last_displacement_.segment(Index(i) * d, d) = displacement.segment(nodes_[i] * d, d);
  free_way_ = 0.5 * std::max(apart, resolution_);  // both bodies may have moved
}

bool BodyWatch::is_due(const Vector& displacement) const {
  const Index d = positions_.rows();
  const double limit = free_way_ * free_way_;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    double squared = 0.0;
    for (Index k = 0; k < d; ++k) {
      const double moved = displacement[nodes_[i] * d + k] - last_displacement_[Index(i) * d + k];
      squared += moved * moved;
    }
    if (squared >= limit) return true;
  }
  return false;
}

double BodyWatch::check_pair(int first, int second, double time) {
  const Eigen::AlignedBox3d& box = surfaces_[std::size_t(first)].box();
  const double apart = box.exteriorDistance(surfaces_[std::size_t(second)].box());
  if (apart > 0.0) return apart;
  return std::min(check_nodes(first, second, time), check_nodes(second, first, time));
}

double BodyWatch::check_nodes(int of, int inside, double time) {
  const BodySurface& own = surfaces_[std::size_t(of)];
  const BodySurface& other = surfaces_[std::size_t(inside)];
  const double size = std::min(size_[std::size_t(of)], size_[std::size_t(inside)]);
  double apart = std::numeric_limits<double>::infinity();
  const auto found = allowances_.find({of, inside});
  for (std::size_t i = 0; i < own.nodes().size(); ++i) {
    const Eigen::Vector3d& position = own.positions()[i];
    double distance = other.box().exteriorDistance(position);
    if (!(distance > 0.0)) distance = other.signed_distance(position);
    apart = std::min(apart, std::abs(distance));
    const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * position.lpNorm<Eigen::Infinity>();
    if (-distance <= std::max(rounding_of_depth * size, rounding)) continue;
    const Allowance here = found != allowances_.end() ? found->second[i] : Allowance{};
    if (here.contact >= 0 && -distance <= here.depth_allowed(*gap_)) continue;
    BodyPair& pair = pair_of(std::min(of, inside), std::max(of, inside));
    if (here.contact < 0) {
      pair.deepest.enter(own.nodes()[i], -distance, time, position);
    } else if (-distance > pair.at_contact.depth) {
      pair.at_contact.enter(own.nodes()[i], -distance, time, position);
      pair.contact = here.contact;
    }
  }
  return apart;
}

bool BodyWatch::has_found(int first, int second) const {
  return std::ranges::any_of(pairs_,
                             [&](const BodyPair& pair) { return pair.first == first && pair.second == second; });
}

BodyPair& BodyWatch::pair_of(int first, int second) {
  for (BodyPair& pair : pairs_) {
    if (pair.first == first && pair.second == second) return pair;
  }
  pairs_.push_back({first, second, {}, {}, -1});
  return pairs_.back();
}

void BodyWatch::persist(const SnapshotVisitor& visit) {
  visit.list("pairs", pairs_);
  visit("seen", last_displacement_, last_displacement_.size());
  visit("free_way", free_way_);
  visit("looks", checks_);
}

}  // namespace ricochet
