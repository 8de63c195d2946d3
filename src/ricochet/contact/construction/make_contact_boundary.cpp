#include "ricochet/contact/construction/make_contact_boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/contact/construction/boundary_patch.hpp"
#include "ricochet/contact/contact_directions.hpp"
#include "ricochet/contact/contact_surface.hpp"
#include "ricochet/contact/curved_contact.hpp"

namespace ricochet {

namespace {

using Patches = std::vector<std::unique_ptr<BoundaryPatch>>;

std::vector<Index> facets_of(const std::vector<ContactPair>& pairs) {
  std::vector<Index> result;
  for (const ContactPair& pair : pairs) {
    if (pair.tied) continue;
    result.insert(result.end(), pair.facets.begin(), pair.facets.end());
    result.insert(result.end(), pair.opposite_facets.begin(), pair.opposite_facets.end());
  }
  std::ranges::sort(result);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

void resize(ContactBoundary& boundary, ContactRows& rows, Index count) {
  boundary.pair.resize(std::size_t(count));
  rows.normals.resize(boundary.dimension, count);
  rows.tangents.resize(std::size_t(count));
  rows.slips.assign(std::size_t(count * (boundary.dimension - 1)), 0);
  rows.gap_rounding.resize(count);
  boundary.initial_gap.resize(count);
  boundary.weights.resize(count);
  boundary.net.resize(count);
  boundary.large_sliding.assign(std::size_t(count), 0);
  boundary.rows_follow.assign(std::size_t(count), 0);
  boundary.friction_coefficient.resize(count);
  boundary.friction_bound.resize(count);
}

/// Multipliers in stress units need positive weights; a nodal force needs one only if its friction is a stress.
void check_weights(const BoundaryPatch& patch, const std::vector<ContactPair>& pairs) {
  if (patch.obstacle == nullptr) return;  // points that are hardly covered are already omitted
  double largest = 0.0;
  for (const Multiplier& multiplier : patch.retained) largest = std::max(largest, multiplier.weight);
  for (const Multiplier& multiplier : patch.retained) {
    const ContactPair& pair = pairs[std::size_t(multiplier.pair)];
    if (patch.space->has_functions() && multiplier.weight <= 1e-10 * largest) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("contact group \"{}\": a multiplier of \"{}\" has no positive share of the area; its "
                              "facets are too strongly curved",
                              pair.group, pair.multipliers));
    }
    if (!patch.space->has_functions() && pair.friction.bound > 0.0 && multiplier.weight < -1e-10 * largest) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("contact group \"{}\": a node's share of the area is negative on its curved facets, so a "
                              "friction bound is meaningless for its force; use multipliers \"dual\" or \"p1\"",
                              pair.group));
    }
  }
}

void fill_friction(const BoundaryPatch& patch, const std::vector<ContactPair>& pairs, ContactBoundary& boundary) {
  for (std::size_t i = 0; i < patch.retained.size(); ++i) {
    const FrictionLaw& law = pairs[std::size_t(patch.retained[i].pair)].friction;
    boundary.friction_coefficient[patch.numbers[i]] = law.coefficient;
    boundary.friction_bound[patch.numbers[i]] = 0.0;
    if (law.bound == 0.0) continue;
    // Weights of nodal forces at the vertices of flat triangles of degree 2 vanish: a negative rounding error counts as
    // zero, and with it the friction that the bound admits.
    const double bound = law.bound * std::max(patch.retained[i].weight, 0.0);
    boundary.friction_bound[patch.numbers[i]] = bound;
    if (bound == 0.0) boundary.friction_coefficient[patch.numbers[i]] = 0.0;
  }
}

/// Assembles G = t ⊗ nᵀ and B_T = t ⊗ τᵀ.
class Operators {
 public:
  explicit Operators(int dimension) : d_(dimension) {}

  /// Adds a point. `follows`: whether rows follow the motion; a row of G may then have entries at some more nodes, and
  /// rows of B_T, too, have entries at those of a rigid body (−1 without one).
  void add(int point, const Multiplier& multiplier, const TiedNodes::Weights& free_trace,
           const PointConditions& conditions, const ContactTangents& tangents, bool follows,
           const std::vector<Index>& more_nodes, Index nodes_of_body) {
    const bool is_flat = !follows;
    for (int dof = int(nodes_of_body) * d_, k = 0; nodes_of_body >= 0 && k < 2 * d_; ++k) {
      gap_.emplace_back(point, dof + k, 0.0);
      for (int j = 0; j < d_ - 1; ++j) slip_.emplace_back(point * (d_ - 1) + j, dof + k, 0.0);
    }
    for (const auto& [node, weight] : multiplier.trace) own_.emplace_back(point, int(node), weight);
    for (const Index node : more_nodes) {
      for (int k = 0; k < d_; ++k) gap_.emplace_back(point, int(node) * d_ + k, 0.0);
    }
    for (const auto& [node, weight] : free_trace) add_node(point, node, weight, conditions.normal, tangents, is_flat);
    for (const auto& [node, weight] : conditions.opposite)
      add_node(point, node, -weight, conditions.normal, tangents, is_flat);
  }

  void finish(Index points, Index nodes, ContactBoundary& boundary, ContactRows& rows) const {
    boundary.trace.resize(points, nodes);
    boundary.trace.setFromTriplets(trace_.begin(), trace_.end());
    boundary.own_trace.resize(points, nodes);
    boundary.own_trace.setFromTriplets(own_.begin(), own_.end());
    rows.gap_operator.resize(points, nodes * d_);
    rows.gap_operator.setFromTriplets(gap_.begin(), gap_.end());
    rows.tangential_trace.resize(points * (d_ - 1), nodes * d_);
    rows.tangential_trace.setFromTriplets(slip_.begin(), slip_.end());
  }

 private:
  void add_node(int point, Index node, double weight, const Vector& normal, const ContactTangents& tangents,
                bool is_flat) {
    trace_.emplace_back(point, int(node), weight);
    for (int k = 0; k < d_; ++k) {
      const int dof = int(node) * d_ + k;
      gap_.emplace_back(point, dof, weight * normal[k]);
      for (int j = 0; j < d_ - 1; ++j) {
        const bool slips = tangents.slips[std::size_t(j)];
        if (!slips && is_flat) continue;  // a row that follows the motion always has its entries
        slip_.emplace_back(point * (d_ - 1) + j, dof, slips ? weight * tangents.directions(k, j) : 0.0);
      }
    }
  }

  int d_;
  std::vector<Eigen::Triplet<double>> trace_, own_, gap_, slip_;
};

/// Returns the first of the nodes of a free rigid body, or −1.
Index nodes_of_body(const BoundaryPatch& patch) {
  const FreeMotion* const body = patch.obstacle != nullptr ? patch.obstacle->free_motion() : nullptr;
  return body != nullptr ? body->centre_node() : -1;
}

void fill_points(const BoundaryPatch& patch, const FreeComponent& is_free, ContactBoundary& boundary, ContactRows& rows,
                 Operators& operators) {
  for (std::size_t i = 0; i < patch.retained.size(); ++i) {
    const Multiplier& multiplier = patch.retained[i];
    const PointConditions& conditions = patch.conditions[i];
    const int number = patch.numbers[i];
    const ContactTangents tangents =
        tangents_at(freest_node(patch, i, boundary.dimension, is_free), conditions.normal, is_free);
    boundary.pair[std::size_t(number)] = multiplier.pair;
    boundary.initial_gap[number] = conditions.gap;
    rows.gap_rounding[number] = conditions.gap_rounding;
    rows.normals.col(number) = conditions.normal;
    rows.tangents[std::size_t(number)] = tangents.directions;
    for (int k = 0; k < boundary.dimension - 1; ++k) {
      const bool slips = tangents.slips[std::size_t(k)];
      rows.slips[std::size_t(number * (boundary.dimension - 1) + k)] = slips ? 1 : 0;
    }
    boundary.weights[number] = multiplier.weight;
    boundary.net[number] = patch.obstacle != nullptr ? 1.0 : 0.0;
    boundary.rows_follow[std::size_t(number)] = patch.follows_motion() ? 1 : 0;
    operators.add(
        number, multiplier, patch.free_traces[i], conditions, tangents, patch.follows_motion(),
        patch.rotating_normals.empty() || patch.slides ? std::vector<Index>{} : patch.rotating_normals[i].nodes(),
        nodes_of_body(patch));
  }
}

/// Creates the geometry of points and nodes at curved obstacles; null if there are none.
std::unique_ptr<ContactGeometry> make_curved_geometry(const Body& body, const Patches& patches,
                                                      const std::vector<ContactPair>& pairs,
                                                      const FreeComponent& is_free, const ContactBoundary& boundary) {
  CurvedContactData data;
  const auto number_of = [&data](const Obstacle* obstacle) {
    const auto found = std::ranges::find(data.obstacles, obstacle);
    const auto number = std::size_t(found - data.obstacles.begin());
    if (found == data.obstacles.end()) data.obstacles.push_back(obstacle);
    return number;
  };
  for (const auto& patch : patches) {
    if (patch->obstacle == nullptr || patch->obstacle->has_constant_normals()) continue;
    for (std::size_t i = 0; i < patch->retained.size(); ++i) {
      const Index node = freest_node(*patch, i, boundary.dimension, is_free);
      CurvedContactData::Point point{patch->numbers[i], number_of(patch->obstacle), {}};
      for (int k = 0; k < boundary.dimension; ++k) point.is_free[std::size_t(k)] = is_free(node, k);
      data.points.push_back(point);
    }
  }
  for (std::size_t i = 0; i < boundary.nodes.size(); ++i) {
    const Obstacle* const obstacle = pairs[std::size_t(boundary.node_pair[i])].obstacle;
    if (obstacle != nullptr && !obstacle->has_constant_normals())
      data.nodes.push_back({Index(i), boundary.nodes[i], number_of(obstacle)});
  }
  if (data.points.empty()) return nullptr;
  data.node_positions = body.space->nodes;
  data.node_normals = boundary.node_normals;
  data.trace = boundary.trace;
  return make_curved_contact(std::move(data));
}

/// Creates the geometry of points and nodes where gaps and normals follow the motion.
void follow_motion(const Body& body, const Patches& patches, const std::vector<ContactPair>& pairs,
                   const FreeComponent& is_free, ContactRows& rows, ContactBoundary& boundary) {
  std::vector<std::unique_ptr<ContactGeometry>> parts;
  parts.push_back(make_curved_geometry(body, patches, pairs, is_free, boundary));
  parts.push_back(make_rotating_geometry(body, pairs, patches, is_free, boundary));
  parts.push_back(make_sliding_geometry(body, pairs, patches, is_free, boundary));
  std::erase(parts, nullptr);
  if (parts.empty()) return;
  rows.revision.assign(std::size_t(rows.size()), 0);
  boundary.geometry = combine(std::move(parts));
  // Initial gaps must be consistent with the rows, which are their derivatives.
  Vector gap = boundary.initial_gap;
  boundary.geometry->gaps(Vector::Zero(body.space->dof_count()), 0.0, gap);
  boundary.initial_gap = gap;
  rows.gap = gap;
  const auto reaches_more = [](const ContactPair& pair) {
    return pair.large_sliding || (pair.obstacle != nullptr && pair.obstacle->free_motion() != nullptr);
  };
  if (std::ranges::none_of(pairs, reaches_more)) return;
  // Creates, at points in contact, the entries of free rigid bodies, and those of opposite surfaces.
  boundary.geometry->update(Vector::Zero(body.space->dof_count()), 0.0, nullptr, rows);
  // Numbers the initial rows 0, independent of the numbers of later updates.
  rows.revision.assign(std::size_t(rows.size()), 0);
}

}  // namespace

Index freest_node(const BoundaryPatch& patch, std::size_t index, int dimension, const FreeComponent& is_free) {
  const PointConditions& conditions = patch.conditions[index];
  if (patch.retained[index].node >= 0 && conditions.opposite.empty()) return patch.retained[index].node;
  Index freest = -1;
  int most = -1;
  for (const auto* const nodes : {&patch.free_traces[index], &conditions.opposite}) {
    for (const auto& [node, weight] : *nodes) {
      int free = 0;
      for (int k = 0; k < dimension; ++k) free += is_free(node, k) ? 1 : 0;
      if (free > most) {
        most = free;
        freest = node;
      }
    }
  }
  return freest;
}

ContactBoundary make_contact_boundary(const Body& body, const std::vector<ContactPair>& pairs,
                                      const FreeComponent& is_free, Index* supported_nodes,
                                      std::vector<PairingSummary>* facings) {
  const BoundaryNodes nodes(body, pairs, is_free);
  if (supported_nodes != nullptr) *supported_nodes = nodes.supported_count();
  std::vector<PairingSummary> found;
  const Patches patches = make_patches(body, pairs, nodes, is_free, facings != nullptr ? *facings : found);
  if (has_finite_strain(body)) find_rotating_normals(body, pairs, patches);
  ContactBoundary boundary;
  boundary.dimension = body.space->dimension;
  boundary.facets = facets_of(pairs);
  Index count = 0;
  for (const auto& patch : patches) count += Index(patch->retained.size());
  const auto rows = std::make_shared<ContactRows>();
  resize(boundary, *rows, count);
  Operators operators(boundary.dimension);
  for (const auto& patch : patches) {
    check_weights(*patch, pairs);
    fill_points(*patch, is_free, boundary, *rows, operators);
    fill_friction(*patch, pairs, boundary);
  }
  operators.finish(count, body.space->node_count(), boundary, *rows);
  fill_boundary_nodes(patches, nodes, body, pairs, boundary);
  follow_motion(body, patches, pairs, is_free, *rows, boundary);
  boundary.rows = rows;
  boundary.surface = std::make_shared<const ContactSurface>(body, pairs, boundary);
  return boundary;
}

}  // namespace ricochet
