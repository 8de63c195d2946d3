#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/point_sets.hpp"
#include "ricochet/contact/construction/boundary_patch.hpp"
#include "ricochet/contact/mortar/corner_pairs.hpp"
#include "ricochet/contact/mortar/paired_surfaces.hpp"
#include "ricochet/contact/sliding/sliding_contact.hpp"

/// @file Pairs of bodies with unlimited sliding: their points, and the geometry that updates their rows.
namespace ricochet {

namespace {

/// Initial normals out of the opposite surface; a common one for facets around an edge, and for nodes on an axis.
class OwnNormals {
 public:
  OwnNormals(const Body& body, const ContactPair& pair)
      : body_(body),
        surface_(body, pair.facets),
        areas_(areas_around_nodes(body, surface_)),
        around_(facets_around_nodes(*body.space, pair.facets)) {
    for (const FacetSurface::Facet& facet : surface_.facets())
      of_facet_[facet.number] = -facet.area_vector.normalized();
  }

  [[nodiscard]] RotatingNormal at_node(Index node) const {
    const Vector direction = -areas_.at(node).vector.normalized().head(body_.mesh->dimension);
    if (is_on_axis(body_, node)) return RotatingNormal(direction);
    return {*body_.space, around_.at(node), direction};
  }
  [[nodiscard]] RotatingNormal at_facet(Index facet) const {
    return {*body_.space, {facet}, Vector(of_facet_.at(facet).head(body_.mesh->dimension))};
  }
  [[nodiscard]] RotatingNormal of(const Multiplier& multiplier) const {
    return multiplier.node >= 0 ? at_node(multiplier.node) : at_facet(multiplier.facet);
  }
  /// Length of the mean of unit normals around a node: 1 if they agree.
  [[nodiscard]] double agreement(Index node) const { return areas_.at(node).vector.norm() / areas_.at(node).size; }

 private:
  const Body& body_;
  FacetSurface surface_;
  std::map<Index, AreaSum> areas_;
  FacetsAround around_;
  std::map<Index, Eigen::Vector3d> of_facet_;
};

void check_normals(const Body& body, const ContactPair& pair, const OwnNormals& normals, PairingSummary& facing) {
  for (const Index node : facet_nodes(*body.space, pair.facets)) {
    const double agreement = normals.agreement(node);
    if (agreement >= facing.agreement) continue;
    facing.agreement = agreement;
    facing.edge = body.space->nodes.col(node);
  }
  refuse_fold(pair, facing);
}

void check_ties(const Body& body, const ContactPair& pair) {
  if (body.tied == nullptr) return;
  for (const auto* const facets : {&pair.facets, &pair.opposite_facets}) {
    for (const Index node : facet_nodes(*body.space, *facets)) {
      if (!body.tied->is_tied(node)) continue;
      const Vector at = body.space->nodes.col(node);
      throw Error(ErrorKind::invalid_input,
                  fmt::format("contact groups \"{}\" and \"{}\": the node at ({:.6g}) is tied to another surface, but "
                              "surfaces that slide far cannot have tied nodes; remove its facets from the groups, or "
                              "tie the other side of that surface (multipliers_on of the tie)",
                              pair.group, pair.opposite_group, fmt::join(at, ", ")));
    }
  }
}

double area_of(const Body& body, const std::vector<Index>& facets) {
  const FacetIntegration integration(body);
  FacetQuadrature quadrature;
  double area = 0.0;
  for (const Index facet : facets) {
    integration.evaluate(facet, quadrature);
    area += quadrature.measure.sum();
  }
  return area;
}

SlidingPair::Point sliding_point(const BoundaryPatch& patch, std::size_t index, int dimension,
                                 const FreeComponent& is_free) {
  SlidingPair::Point point{.number = patch.numbers[index],
                           .multiplier = patch.retained[index],
                           .normal = patch.rotating_normals[index],
                           .offset = patch.conditions[index].gap};
  for (int k = 0; k < dimension; ++k) {
    point.is_free[std::size_t(k)] =
        std::ranges::any_of(point.multiplier.trace, [&](const auto& entry) { return is_free(entry.first, k); });
  }
  return point;
}

SlidingPair::Data data_of(const Body& body, const ContactPair& pair, const BoundaryPatch& patch,
                          const FreeComponent& is_free) {
  SlidingPair::Data data{body, pair.multipliers, pair.facets, pair.opposite_facets, {}, pair.is_one_of_many};
  for (std::size_t i = 0; i < patch.retained.size(); ++i)
    data.points.push_back(sliding_point(patch, i, body.space->dimension, is_free));
  return data;
}

/// Evaluates the pairing at the initial positions, and sets offsets that close gaps there.
void evaluate_at_start(const Body& body, const ContactPair& pair, const FreeComponent& is_free, BoundaryPatch& patch,
                       PairingSummary& facing) {
  patch.numbers.assign(patch.retained.size(), 0);
  const SlidingPair sliding(data_of(body, pair, patch, is_free));
  std::vector<SlidingView> views;
  sliding.compute_views(Vector::Zero(body.space->dof_count()), SlidingPair::Content::gap, {}, {}, views);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].faces) {
      ++facing.uncovered;
      continue;
    }
    facing.smallest_gap = std::min(facing.smallest_gap, views[i].gap);
    facing.largest_gap = std::max(facing.largest_gap, views[i].gap);
    if (!pair.closed_gaps || views[i].gap >= 0.0) continue;
    patch.conditions[i].gap -= views[i].gap;
    ++facing.closed;
  }
}

}  // namespace

void make_sliding_patch(const Body& body, const ContactPair& pair, const FreeComponent& is_free, BoundaryPatch& patch,
                        PairingSummary& facing) {
  check_ties(body, pair);
  patch.slides = true;
  patch.space = make_multiplier_space(patch.multipliers, patch.facets);
  const OwnNormals normals(body, pair);
  check_normals(body, pair, normals, facing);
  const std::vector<Index> corners = pair.at_corners ? convex_corners(body, pair.facets) : std::vector<Index>{};
  for (Multiplier& multiplier : patch.space->multipliers()) {
    if (pair.at_corners && !std::ranges::binary_search(corners, multiplier.node)) continue;
    const auto moves = [&](const auto& entry) {
      for (int k = 0; k < body.space->dimension; ++k) {
        if (is_free(entry.first, k)) return true;
      }
      return false;
    };
    if (std::ranges::none_of(multiplier.trace, moves)) {
      ++facing.held;
      continue;
    }
    RotatingNormal normal = normals.of(multiplier);
    const Eigen::Vector3d direction = normal.at(body.space->nodes, {});
    const double allowance = pair.at_corners ? corner_allowance * multiplier.weight : 0.0;
    patch.conditions.push_back({direction.normalized().head(body.space->dimension), {}, allowance, 0.0});
    patch.rotating_normals.push_back(std::move(normal));
    patch.retained.push_back(std::move(multiplier));
  }
  facing.points = Index(patch.retained.size());
  facing.area = facing.covered = area_of(body, pair.facets);
  const double rounding = extent(body.space->nodes) * std::numeric_limits<double>::epsilon();
  for (PointConditions& conditions : patch.conditions) conditions.gap_rounding = 64.0 * rounding;
  facing.gap_rounding = 64.0 * rounding;
  for (const Index node : facet_nodes(*body.space, pair.facets)) {
    const Eigen::Vector3d direction = normals.at_node(node).at(body.space->nodes, {});
    patch.nodes.push_back({node, true, direction.normalized().head(body.space->dimension), 0.0, {}});
  }
  evaluate_at_start(body, pair, is_free, patch, facing);
}

std::unique_ptr<ContactGeometry> make_sliding_geometry(const Body& body, const std::vector<ContactPair>& pairs,
                                                       const std::vector<std::unique_ptr<BoundaryPatch>>& patches,
                                                       const FreeComponent& is_free, ContactBoundary& boundary) {
  SlidingContactData data;
  boundary.opposite_node.assign(pairs.size(), -1);
  for (const auto& patch : patches) {
    if (!patch->slides) continue;
    const int number = patch->first_pair();
    const ContactPair& pair = pairs[std::size_t(number)];
    boundary.opposite_node[std::size_t(number)] = facet_nodes(*body.space, pair.opposite_facets).front();
    boundary.touches_itself = boundary.touches_itself || pair.is_self();
    const OwnNormals normals(body, pair);
    for (std::size_t entry = 0; entry < boundary.nodes.size(); ++entry) {
      if (boundary.node_pair[entry] != number) continue;
      const Index node = boundary.nodes[entry];
      data.nodes.push_back({Index(entry), node, data.pairs.size(), normals.at_node(node)});
    }
    data.pairs.push_back(std::make_unique<SlidingPair>(data_of(body, pair, *patch, is_free)));
    const std::vector<Index>& reached = data.pairs.back()->nodes();
    boundary.reachable_nodes.insert(boundary.reachable_nodes.end(), reached.begin(), reached.end());
    for (const int point : patch->numbers) boundary.large_sliding[std::size_t(point)] = 1;
  }
  if (data.pairs.empty()) return nullptr;
  std::ranges::sort(data.nodes, [](const auto& one, const auto& other) { return one.entry < other.entry; });
  data.node_positions = body.space->nodes;
  data.node_normals = boundary.node_normals;
  // In diameters of the model.
  constexpr double unpaired_gap = 1e3;
  data.unpaired_gap = boundary.unpaired_gap = unpaired_gap * enclosing_diameter(body.space->nodes);
  return make_sliding_contact(std::move(data));
}

}  // namespace ricochet
