#include "ricochet/contact/contact_boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/contact/boundary_nodes.hpp"
#include "ricochet/contact/contact_directions.hpp"
#include "ricochet/contact/curved_contact.hpp"
#include "ricochet/contact/multiplier_space.hpp"

namespace ricochet {

namespace {

std::vector<Index> facets_of(const std::vector<ContactPair>& pairs) {
  std::vector<Index> result;
  for (const ContactPair& pair : pairs) result.insert(result.end(), pair.facets.begin(), pair.facets.end());
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// A patch with its space and the multipliers in use.
struct Patch {
  const Obstacle* obstacle = nullptr;
  std::string multipliers;
  ContactPatch facets;
  std::unique_ptr<MultiplierSpace> space;
  std::vector<Multiplier> kept;
  std::vector<int> numbers;  ///< of the kept multipliers among all contact points
};

std::vector<Patch> collect_patches(const Body& body, const std::vector<ContactPair>& pairs) {
  std::vector<Patch> patches;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto same = [&](const Patch& patch) {
      return patch.obstacle == pairs[k].obstacle && patch.multipliers == pairs[k].multipliers;
    };
    auto patch = std::find_if(patches.begin(), patches.end(), same);
    if (patch == patches.end()) {
      patches.push_back({pairs[k].obstacle, pairs[k].multipliers, {&body, {}, {}}, nullptr, {}, {}});
      patch = patches.end() - 1;
    }
    patch->facets.parts.push_back({static_cast<int>(k), pairs[k].facets});
  }
  return patches;
}

/// Leaves out the multipliers that could only press against supports.
void keep_free_multipliers(Patch& patch) {
  patch.kept = patch.space->multipliers();
  std::erase_if(patch.kept,
                [&](const Multiplier& multiplier) { return only_presses_supports(multiplier, patch.facets); });
}

/// Numbers the contact points: by node (a facet counts as its first one), then by pair.
Index number_points(std::vector<Patch>& patches) {
  using Key = std::tuple<Index, int, std::size_t, std::size_t>;
  std::vector<Key> order;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    patches[p].numbers.resize(patches[p].kept.size());
    for (std::size_t i = 0; i < patches[p].kept.size(); ++i) {
      const Multiplier& multiplier = patches[p].kept[i];
      order.emplace_back(multiplier.node >= 0 ? multiplier.node : multiplier.trace.front().first, multiplier.pair, p,
                         i);
    }
  }
  std::sort(order.begin(), order.end());
  for (std::size_t number = 0; number < order.size(); ++number) {
    const auto& [node, pair, p, i] = order[number];
    patches[p].numbers[i] = static_cast<int>(number);
  }
  return static_cast<Index>(order.size());
}

void resize(ContactBoundary& boundary, ContactRows& rows, Index count) {
  boundary.pair.resize(static_cast<std::size_t>(count));
  rows.normals.resize(boundary.dimension, count);
  rows.tangents.resize(static_cast<std::size_t>(count));
  rows.slips.assign(static_cast<std::size_t>(count * (boundary.dimension - 1)), 0);
  rows.gap_rounding.resize(count);
  boundary.initial_gap.resize(count);
  boundary.weights.resize(count);
  boundary.friction_coefficient.resize(count);
  boundary.friction_bound.resize(count);
}

/// Mean of a multiplier's nodes; its own for one that is anchored at a node.
Vector anchor_position(const DisplacementSpace& space, const Multiplier& multiplier) {
  if (multiplier.node >= 0) return space.nodes.col(multiplier.node);
  Vector position = Vector::Zero(space.dimension);
  for (const auto& [node, weight] : multiplier.trace) position += weight * space.nodes.col(node);
  return position;
}

/// The node whose supports decide along which tangents there is friction.
Index freest_node(const Multiplier& multiplier, int dimension, const FreeComponent& is_free) {
  if (multiplier.node >= 0) return multiplier.node;
  Index freest = -1;
  int most = -1;
  for (const auto& [node, weight] : multiplier.trace) {
    int free = 0;
    for (int k = 0; k < dimension; ++k) free += is_free(node, k) ? 1 : 0;
    if (free > most) {
      most = free;
      freest = node;
    }
  }
  return freest;
}

/// (1/D_i) ∫ψ_i g₀ over the curved facets, by anchor.
std::map<Index, double> mean_gaps(const Patch& patch) {
  std::map<Index, double> gaps, weights;
  const FacetIntegration integration(*patch.facets.body);
  FacetQuadrature quadrature;
  FacetMultipliers functions;
  Vector gap;
  for (const ContactPatch::Part& part : patch.facets.parts) {
    for (const Index facet : part.facets) {
      integration.evaluate(facet, quadrature);
      patch.space->evaluate(quadrature, functions);
      gap.resize(quadrature.measure.size());
      for (Index q = 0; q < gap.size(); ++q) gap[q] = patch.obstacle->gap(quadrature.positions.col(q));
      const Matrix weighted = functions.values * quadrature.measure.asDiagonal();
      for (std::size_t k = 0; k < functions.anchors.size(); ++k) {
        gaps[functions.anchors[k]] += weighted.row(static_cast<Index>(k)).dot(gap);
        weights[functions.anchors[k]] += weighted.row(static_cast<Index>(k)).sum();
      }
    }
  }
  for (auto& [anchor, gap_integral] : gaps) gap_integral /= weights.at(anchor);
  return gaps;
}

/// g₀ and its rounding. Where the displacement's space contains the geometry, the trace of the nodes' gaps is the mean
/// gap against planes, exactly.
void fill_gaps(const Patch& patch, const Body& body, ContactBoundary& boundary, ContactRows& rows) {
  // Displacements come from solves over the whole body, so their rounding is relative to its size, wherever a node is.
  const double body_size = extent(body.space->nodes);
  const double body_rounding = 8.0 * std::numeric_limits<double>::epsilon() * body_size;
  const bool by_quadrature = patch.space->has_functions() && body.mesh->degree > body.space->degree;
  const std::map<Index, double> means = by_quadrature ? mean_gaps(patch) : std::map<Index, double>{};
  for (std::size_t i = 0; i < patch.kept.size(); ++i) {
    const Multiplier& multiplier = patch.kept[i];
    double gap = 0.0;
    double rounding = 0.0;
    for (const auto& [node, weight] : multiplier.trace) {
      const Vector position = body.space->nodes.col(node);
      gap += weight * patch.obstacle->gap(position);
      rounding += std::abs(weight) * (patch.obstacle->gap_rounding(position) + body_rounding);
    }
    if (by_quadrature) gap = means.at(multiplier.node >= 0 ? multiplier.node : multiplier.facet);
    boundary.initial_gap[patch.numbers[i]] = gap;
    rows.gap_rounding[patch.numbers[i]] = rounding;
  }
}

/// Multipliers in stress units need positive weights; a nodal force needs one only where friction is a stress.
void check_weights(const Patch& patch, const std::vector<ContactPair>& pairs) {
  double largest = 0.0;
  for (const Multiplier& multiplier : patch.kept) largest = std::max(largest, multiplier.weight);
  for (const Multiplier& multiplier : patch.kept) {
    const ContactPair& pair = pairs[static_cast<std::size_t>(multiplier.pair)];
    if (patch.space->has_functions() && multiplier.weight <= 1e-10 * largest) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("contact group \"{}\": a multiplier of \"{}\" has no positive share of the area; its "
                              "facets are too strongly curved",
                              pair.group, pair.multipliers));
    }
    if (!patch.space->has_functions() && pair.friction.bound > 0.0 && multiplier.weight < -1e-10 * largest) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("contact group \"{}\": a node's share of the area is negative on its curved facets, so "
                              "a friction bound has no meaning for its force; use multipliers \"dual\" or \"p1\"",
                              pair.group));
    }
  }
}

void fill_friction(const Patch& patch, const std::vector<ContactPair>& pairs, ContactBoundary& boundary) {
  for (std::size_t i = 0; i < patch.kept.size(); ++i) {
    const FrictionLaw& law = pairs[static_cast<std::size_t>(patch.kept[i].pair)].friction;
    boundary.friction_coefficient[patch.numbers[i]] = law.coefficient;
    boundary.friction_bound[patch.numbers[i]] = 0.0;
    if (law.bound == 0.0) continue;
    // Weights of nodal forces at the vertices of flat triangles of degree 2 vanish: a rounding error below zero is
    // zero, and with it the friction that the bound leaves.
    const double bound = law.bound * std::max(patch.kept[i].weight, 0.0);
    boundary.friction_bound[patch.numbers[i]] = bound;
    if (bound == 0.0) boundary.friction_coefficient[patch.numbers[i]] = 0.0;
  }
}

/// G = c ⊗ nᵀ and B_T = c ⊗ tᵀ.
class Operators {
 public:
  explicit Operators(int dimension) : d_(dimension) {}

  void add(int point, const Multiplier& multiplier, const Vector& normal, const ContactTangents& tangents,
           bool is_flat) {
    for (const auto& [node, weight] : multiplier.trace) {
      trace_.emplace_back(point, static_cast<int>(node), weight);
      for (int k = 0; k < d_; ++k) {
        const int dof = static_cast<int>(node) * d_ + k;
        gap_.emplace_back(point, dof, weight * normal[k]);
        for (int j = 0; j < d_ - 1; ++j) {
          const bool slips = tangents.slips[static_cast<std::size_t>(j)];
          if (!slips && is_flat) continue;  // a row that follows the motion has its entries at all times
          slip_.emplace_back(point * (d_ - 1) + j, dof, slips ? weight * tangents.directions(k, j) : 0.0);
        }
      }
    }
  }

  void finish(Index points, Index nodes, ContactBoundary& boundary, ContactRows& rows) const {
    boundary.trace.resize(points, nodes);
    boundary.trace.setFromTriplets(trace_.begin(), trace_.end());
    rows.gap_operator.resize(points, nodes * d_);
    rows.gap_operator.setFromTriplets(gap_.begin(), gap_.end());
    rows.tangential_trace.resize(points * (d_ - 1), nodes * d_);
    rows.tangential_trace.setFromTriplets(slip_.begin(), slip_.end());
  }

 private:
  int d_;
  std::vector<Eigen::Triplet<double>> trace_, gap_, slip_;
};

/// The nodes that traces reach, and what is reported at them.
void fill_nodes(const std::vector<Patch>& patches, const BoundaryNodes& all, const Body& body,
                const std::vector<ContactPair>& pairs, ContactBoundary& boundary) {
  std::map<std::pair<Index, int>, int> rows;  // (node, first pair) → row
  for (const Patch& patch : patches) {
    for (const Multiplier& multiplier : patch.kept) {
      for (const auto& [node, weight] : multiplier.trace) rows[{node, all.first_pair(node, patch.obstacle)}] = 0;
    }
  }
  const auto count = static_cast<Index>(rows.size());
  boundary.node_normals.resize(boundary.dimension, count);
  boundary.node_initial_gap.resize(count);
  for (auto& [key, row] : rows) {
    row = static_cast<int>(boundary.nodes.size());
    const Obstacle& obstacle = *pairs[static_cast<std::size_t>(key.second)].obstacle;
    const Vector position = body.space->nodes.col(key.first);
    boundary.nodes.push_back(key.first);
    boundary.node_pair.push_back(key.second);
    boundary.node_normals.col(row) = obstacle.normal(position);
    boundary.node_initial_gap[row] = obstacle.gap(position);
  }
  boundary.own_point.assign(static_cast<std::size_t>(count), -1);
  std::vector<Eigen::Triplet<double>> recovery;
  for (const Patch& patch : patches) {
    for (std::size_t i = 0; i < patch.kept.size(); ++i) {
      const Index node = patch.kept[i].node;
      if (node < 0) continue;
      const int row = rows.at({node, all.first_pair(node, patch.obstacle)});
      boundary.own_point[static_cast<std::size_t>(row)] = patch.numbers[i];
    }
    for (const auto& entry : patch.space->pressure_recovery(patch.kept)) {
      const auto row = rows.find({entry.row(), all.first_pair(entry.row(), patch.obstacle)});
      if (row == rows.end()) continue;  // no multiplier in use reaches the node
      recovery.emplace_back(row->second, patch.numbers[static_cast<std::size_t>(entry.col())], entry.value());
    }
  }
  boundary.pressure_recovery.resize(count, boundary.size());
  boundary.pressure_recovery.setFromTriplets(recovery.begin(), recovery.end());
}

void fill_points(const Patch& patch, const Body& body, const FreeComponent& is_free, ContactBoundary& boundary,
                 ContactRows& rows, Operators& operators) {
  for (std::size_t i = 0; i < patch.kept.size(); ++i) {
    const Multiplier& multiplier = patch.kept[i];
    const int number = patch.numbers[i];
    const Vector normal = patch.obstacle->normal(anchor_position(*body.space, multiplier));
    const ContactTangents tangents = tangents_at(freest_node(multiplier, boundary.dimension, is_free), normal, is_free);
    boundary.pair[static_cast<std::size_t>(number)] = multiplier.pair;
    rows.normals.col(number) = normal;
    rows.tangents[static_cast<std::size_t>(number)] = tangents.directions;
    for (int k = 0; k < boundary.dimension - 1; ++k) {
      const bool slips = tangents.slips[static_cast<std::size_t>(k)];
      rows.slips[static_cast<std::size_t>(number * (boundary.dimension - 1) + k)] = slips ? 1 : 0;
    }
    boundary.weights[number] = multiplier.weight;
    operators.add(number, multiplier, normal, tangents, patch.obstacle->is_flat());
  }
}

/// Points and nodes at curved obstacles, where gaps and normals follow the motion.
void follow_curved_obstacles(const Body& body, const std::vector<Patch>& patches, const std::vector<ContactPair>& pairs,
                             const FreeComponent& is_free, ContactRows& rows, ContactBoundary& boundary) {
  CurvedContactData data;
  for (const Patch& patch : patches) {
    if (patch.obstacle->is_flat()) continue;
    for (std::size_t i = 0; i < patch.kept.size(); ++i) {
      const Index node = freest_node(patch.kept[i], boundary.dimension, is_free);
      CurvedContactData::Point point{patch.numbers[i], patch.obstacle, {}};
      for (int k = 0; k < boundary.dimension; ++k) point.is_free[static_cast<std::size_t>(k)] = is_free(node, k);
      data.points.push_back(point);
    }
  }
  for (std::size_t i = 0; i < boundary.nodes.size(); ++i) {
    const Obstacle* const obstacle = pairs[static_cast<std::size_t>(boundary.node_pair[i])].obstacle;
    if (!obstacle->is_flat()) data.nodes.push_back({static_cast<Index>(i), boundary.nodes[i], obstacle});
  }
  if (data.points.empty()) return;
  rows.revision.assign(static_cast<std::size_t>(rows.size()), 0);
  data.node_positions = body.space->nodes;
  data.node_normals = boundary.node_normals;
  data.trace = boundary.trace;
  boundary.geometry = make_curved_contact(std::move(data));
  // Gaps at the start are those that the rows are the derivatives of.
  Vector gap = boundary.initial_gap;
  boundary.geometry->gaps(Vector::Zero(body.space->dof_count()), 0.0, gap);
  boundary.initial_gap = gap;
  rows.gap = gap;
}

}  // namespace

std::vector<Index> ContactBoundary::unique_nodes() const {
  std::vector<Index> result = nodes;  // ascending already
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

ContactBoundary make_contact_boundary(const Body& body, const std::vector<ContactPair>& pairs,
                                      const FreeComponent& is_free, Index* held_nodes) {
  const BoundaryNodes nodes(body, pairs, is_free);
  if (held_nodes != nullptr) *held_nodes = nodes.held_count();
  std::vector<Patch> patches = collect_patches(body, pairs);
  for (Patch& patch : patches) {
    const Obstacle* obstacle = patch.obstacle;
    patch.facets.is_held = [&nodes, obstacle](Index node) { return nodes.is_held(node, obstacle); };
    patch.space = make_multiplier_space(patch.multipliers, patch.facets);
    keep_free_multipliers(patch);
  }
  ContactBoundary boundary;
  boundary.dimension = body.space->dimension;
  boundary.facets = facets_of(pairs);
  const Index count = number_points(patches);
  const auto rows = std::make_shared<ContactRows>();
  resize(boundary, *rows, count);
  Operators operators(boundary.dimension);
  for (const Patch& patch : patches) {
    check_weights(patch, pairs);
    fill_points(patch, body, is_free, boundary, *rows, operators);
    fill_gaps(patch, body, boundary, *rows);
    fill_friction(patch, pairs, boundary);
  }
  operators.finish(count, body.space->node_count(), boundary, *rows);
  fill_nodes(patches, nodes, body, pairs, boundary);
  follow_curved_obstacles(body, patches, pairs, is_free, *rows, boundary);
  boundary.rows = rows;
  return boundary;
}

}  // namespace ricochet
