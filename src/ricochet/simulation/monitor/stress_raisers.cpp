#include "ricochet/simulation/monitor/stress_raisers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ricochet {

namespace {

constexpr double right_angle = 0.5 * std::numbers::pi;
/// Cosine between a support and a direction up to which the support does not count as one along it.
constexpr double nearly_across = 0.05;
/// Free angle next to a clamped face from which the stress at its border is infinite, for common Poisson's ratios.
constexpr double clamped_angle = std::numbers::pi / 3.0;
/// Change of an obstacle's normal over two cells from which it is sharp for this mesh: that of 30°.
constexpr double sharp_change = 0.52;

/// Returns the raiser to report if both are present: the earlier enumerator.
StressRaiser stronger(StressRaiser a, StressRaiser b) {
  if (a == StressRaiser::none || b == StressRaiser::none) return std::max(a, b);
  return std::min(a, b);
}

}  // namespace

std::string name_of(StressRaiser raiser) {
  static const std::array<std::string, stress_raisers> names{"", "a re-entrant edge of the body",
                                                             "the edge of a support", "a sharp edge in contact",
                                                             "contact with a sharp edge of an obstacle"};
  return names[std::size_t(raiser)];
}

StressRaisers::StressRaisers(const Body& body, const SemidiscreteProblem& problem,
                             const std::vector<ContactPair>& pairs, const BodiesOfMesh& bodies)
    : body_(body), problem_(problem), bodies_(bodies) {
  const auto count = std::size_t(body.space->node_count());
  of_node_.assign(count, StressRaiser::none);
  touching_.assign(count, 0);
  for (const ContactPair& pair : pairs) {
    if (pair.tied) continue;
    const char kind = pair.between_bodies() || pair.friction.any() ? 2 : 1;
    for (const std::vector<Index>* const facets : {&pair.facets, &pair.opposite_facets}) {
      for (const Index node : facet_nodes(*body.space, *facets))
        touching_[std::size_t(node)] = std::max(touching_[std::size_t(node)], kind);
    }
  }
  std::vector<std::vector<Index>> facets;
  for (const CellFacet& facet : bodies.boundary) {
    facets.push_back(nodes_of_facet(body.space->cells, facet));
    facet_supported_.push_back(supported_components(facets.back()));
    facet_touches_.push_back(std::all_of(facets.back().begin(), facets.back().end(),
                                         [this](Index node) { return touching_[std::size_t(node)] != 0; })
                                 ? 1
                                 : 0);
  }
  for (const Ridge& ridge : boundary_ridges(body, bodies.boundary)) judge(ridge);
  reach_neighbours();
  std::ranges::sort(contact_edges_, {}, &ContactEdge::node);
  contact_edges_.erase(std::unique(contact_edges_.begin(), contact_edges_.end(),
                                   [](const ContactEdge& a, const ContactEdge& b) { return a.node == b.node; }),
                       contact_edges_.end());
  for (std::size_t facet = 0; facet < facets.size(); ++facet) {
    if (facet_touches_[facet] == 0) continue;
    for (const Index node : facets[facet]) {
      const auto edge = std::ranges::lower_bound(contact_edges_, node, {}, &ContactEdge::node);
      if (edge != contact_edges_.end() && edge->node == node)
        edge->beside.insert(edge->beside.end(), facets[facet].begin(), facets[facet].end());
    }
  }
}

/// Returns the components that supports hold at all of the nodes, one bit each.
unsigned StressRaisers::supported_components(Nodes nodes) const {
  const int d = problem_.dimension;
  unsigned result = (1U << unsigned(d)) - 1U;
  for (const Index node : nodes) {
    for (int k = 0; k < d; ++k) {
      if (!problem_.supports.contains(node * d + k)) result &= ~(1U << unsigned(k));
    }
  }
  return result;
}

StressRaisers::SupportKind StressRaisers::support_of(unsigned components, const Eigen::Vector3d& normal) const {
  if (components == 0) return SupportKind::free;
  int along = 0, across = 0;
  for (int k = 0; k < problem_.dimension; ++k) {
    if ((components >> unsigned(k) & 1U) == 0) continue;
    const double part = std::abs(normal[k]);
    if (part <= nearly_across) {
      ++across;
    } else if (part * part >= 1.0 - nearly_across * nearly_across) {
      ++along;
    } else {
      return SupportKind::fixed;
    }
  }
  const bool is_mirror = (along == 1 && across == 0) || (along == 0 && across == problem_.dimension - 1);
  return is_mirror ? SupportKind::mirror : SupportKind::fixed;
}

void StressRaisers::mark(const Ridge& ridge, StressRaiser raiser) {
  for (const Index node : ridge.nodes) {
    StressRaiser& stored = of_node_[std::size_t(node)];
    stored = stronger(stored, raiser);
  }
}

void StressRaisers::judge(const Ridge& ridge) {
  std::array<SupportKind, 2> support;
  for (std::size_t k = 0; k < 2; ++k) support[k] = support_of(facet_supported_[ridge.facets[k]], ridge.normals[k]);
  if (support[0] == SupportKind::mirror && support[1] == SupportKind::mirror) return;
  const bool is_mirrored = support[0] == SupportKind::mirror || support[1] == SupportKind::mirror;
  // The mirror image doubles the angle of the body.
  const double opening = is_mirrored ? 2.0 * (ridge.angle - right_angle) : ridge.angle;
  const bool sharp = is_sharp(opening, ridge.adjacent_angle);
  const bool is_clamp_end = !is_mirrored && support[0] != support[1];
  if (is_clamp_end && std::numbers::pi - opening > clamped_angle) {
    mark(ridge, StressRaiser::support_edge);
  } else if (sharp && opening < 0.0) {
    mark(ridge, is_mirrored ? StressRaiser::support_edge : StressRaiser::reentrant_edge);
  } else if (sharp && (facet_touches_[ridge.facets[0]] != 0 || facet_touches_[ridge.facets[1]] != 0)) {
    for (const Index node : ridge.nodes) contact_edges_.push_back({node, touching_[std::size_t(node)] == 2, {}});
  }
}

/// Includes the nodes next to those of raisers: the mean over the cell in a corner is often less than that of the next
/// cell.
void StressRaisers::reach_neighbours() {
  const std::vector<StressRaiser> own = of_node_;
  each_cell(body_.space->cells, [&](Index, Nodes nodes) {
    StressRaiser first = StressRaiser::none;
    for (const Index node : nodes) first = stronger(first, own[std::size_t(node)]);
    for (const Index node : nodes) {
      StressRaiser& stored = of_node_[std::size_t(node)];
      stored = stronger(stored, first);
    }
  });
}

SpaceVector StressRaisers::position(const State& state, Index node) const {
  const Index d = problem_.dimension;
  return problem_.nodes.col(node) + state.displacement.segment(node * d, d);
}

void StressRaisers::find_pressed(const State& state) {
  pressed_.assign(of_node_.size(), 0);
  const Vector& reaction = state.forces.normal_reaction;
  for (Index point = 0; point < reaction.size(); ++point) {
    if (!(reaction[point] > 0.0)) continue;
    state.forces.rows->visit_normal(point, [&](Index dof, double value) {
      const auto node = std::size_t(dof / problem_.dimension);
      if (value != 0.0 && node < pressed_.size()) pressed_[node] = 1;
    });
  }
}

/// Returns whether the edge of another body lies on this one, as where equal faces meet: neither presses into the
/// other.
bool StressRaisers::is_flush(const State& state, Index node, double size) const {
  const SpaceVector at = position(state, node);
  return std::ranges::any_of(contact_edges_, [&](const ContactEdge& other) {
    return other.node != node && (position(state, other.node) - at).norm() <= 1e-3 * size;
  });
}

/// Considers edges within the size of the cell around its nodes; those of other bodies around its pressed nodes.
bool StressRaisers::presses_by_edge(const State& state, Nodes nodes, double size) const {
  const std::vector<int>& body_of = bodies_.connected.of_node;
  const auto body = [&](Index node) { return body_of[std::size_t(node)]; };
  const auto presses = [this](Index node) { return pressed_[std::size_t(node)] != 0; };
  const auto is_near = [&](Index edge) {
    const bool is_own = body(edge) == body(nodes.front());
    return std::ranges::any_of(nodes, [&](Index node) {
      return (is_own || presses(node)) && (position(state, node) - position(state, edge)).norm() <= size;
    });
  };
  return std::ranges::any_of(contact_edges_, [&](const ContactEdge& edge) {
    if (!presses(edge.node) || !is_near(edge.node) || is_flush(state, edge.node, size)) return false;
    return edge.is_open_ended || !std::ranges::all_of(edge.beside, presses);
  });
}

/// Returns whether the obstacle's normal varies from side to side as at a ridge that cells of this size cannot follow.
bool StressRaisers::touches_sharp_obstacle(const State& state, Nodes nodes, double size) const {
  const ContactBoundary& contact = problem_.contact;
  const int d = problem_.dimension;
  for (std::size_t entry = 0; entry < contact.nodes.size(); ++entry) {
    const Index node = contact.nodes[entry];
    if (pressed_[std::size_t(node)] == 0 || std::ranges::find(nodes, node) == nodes.end()) continue;
    const Obstacle* const obstacle = problem_.obstacles[std::size_t(contact.node_pair[entry])];
    if (obstacle == nullptr || obstacle->shape().is_flat()) continue;
    const PosedObstacle posed = obstacle->at(state.time, state.displacement);
    const SpaceVector at = position(state, node), normal = posed.normal(at);
    for (int axis = 0; axis < d; ++axis) {
      SpaceVector side = SpaceVector::Unit(d, axis);
      side -= side.dot(normal) * normal;
      if (side.norm() < 0.5) continue;
      side.normalize();
      if ((posed.normal(at + size * side) - posed.normal(at - size * side)).dot(side) > sharp_change) return true;
    }
  }
  return false;
}

StressRaiser StressRaisers::at(const State& state, Index cell) {
  const IndexInBlocks location = locate_cell(*body_.space, cell);
  const CellBlock& block = body_.space->cells[location.block];
  const Nodes nodes(block.cell(location.local), std::size_t(block.nodes_per_cell));
  StressRaiser first = StressRaiser::none;
  for (const Index node : nodes) first = stronger(first, of_node_[std::size_t(node)]);
  if (first != StressRaiser::none || state.forces.normal_reaction.size() == 0) return first;
  double size = 0.0;
  for (const Index node : nodes)
    size = std::max(size, (problem_.nodes.col(node) - problem_.nodes.col(nodes.front())).norm());
  find_pressed(state);
  if (presses_by_edge(state, nodes, size)) return StressRaiser::contact_edge;
  return touches_sharp_obstacle(state, nodes, size) ? StressRaiser::obstacle_edge : StressRaiser::none;
}

}  // namespace ricochet
