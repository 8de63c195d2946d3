#include "ricochet/contact/mortar/body_contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/contact_directions.hpp"
#include "ricochet/contact/mortar/pair_nodes.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;

/// Difference up to which directions are identified: those of a flat surface.
constexpr double same_direction = 1e-13;
/// Fraction of a multiplier's whole area below which it is not covered and no contact point.
constexpr double least_cover = 1e-8;
/// Length of the mean of unit normals below which no direction is defined.
constexpr double folded = 0.5;
/// Distance beyond a surface's boundary, in sizes of a facet, over which it is extrapolated to find a direction.
constexpr double beyond_rim = 0.25;
/// Overlap, relative to the height of cells, that is attributed to the rounding of
/// coordinates in files and set to zero.
constexpr double rounding_of_files = 1e-6;

}  // namespace

void refuse_fold(const ContactPair& pair, const PairingSummary& facing) {
  if (facing.agreement >= folded) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("contact group \"{}\": its facets around the node at ({:.6g}) fold so sharply that they have "
                          "no common direction in which they could meet \"{}\"; remove the facets on one side of the "
                          "edge from the group, or put them into a separate contact",
                          pair.group, fmt::join(facing.edge, ", "), pair.opposite_group));
}

struct BodyPairing::Implementation {
  const Body& body;
  const ContactPair& pair;
  PairedSurfaces surfaces;
  const FacetMap& map = surfaces.map;
  const FacetSurface &own = surfaces.own, &opposite = surfaces.opposite;
  const SegmentFinder& finder = surfaces.finder;
  std::vector<Vector3> normals;              ///< per own facet
  std::map<Index, Vector3> opposite_normal;  ///< of opposite facets, by number
  std::vector<FacetSegments> direct;         ///< per own facet, along its own normal
  std::vector<Index> facing;

  Implementation(const Body& of_body, const ContactPair& of_pair)
      : body(of_body), pair(of_pair), surfaces(of_body, of_pair) {
    for (const FacetSurface::Facet& facet : opposite.facets())
      opposite_normal[facet.number] = facet.area_vector.normalized();
    for (std::size_t k = 0; k < own.facets().size(); ++k) {
      normals.push_back(reused_normal(own.facets()[k].area_vector.normalized()));
      direct.push_back(finder.find(int(k), -normal_of(k)));
      if (!direct.back().segments.empty()) facing.push_back(own.facets()[k].number);
    }
  }

  [[nodiscard]] const Vector3& normal_of(std::size_t facet) const { return normals[facet]; }
  /// Reuses a recent normal that differs by no more than rounding: all facets of a plane have an identical normal.
  [[nodiscard]] Vector3 reused_normal(const Vector3& normal) const {
    constexpr std::size_t memory = 16;
    for (std::size_t k = normals.size(); k > 0 && k + memory > normals.size(); --k) {
      if ((normals[k - 1] - normal).norm() <= same_direction) return normals[k - 1];
    }
    return normal;
  }
  [[nodiscard]] bool faces(std::size_t facet) const { return !direct[facet].segments.empty(); }
  [[nodiscard]] Vector in_mesh(const Vector3& values) const { return values.head(body.mesh->dimension); }

  AnchorDirections find_directions(bool at_facets, PairingSummary& found) const;
  [[nodiscard]] AnchorDirections faced_normals(bool at_facets) const;
  [[nodiscard]] Vector3 normal_between_nodes(const SegmentFinder::Hit& hit,
                                             const std::map<Index, AreaSum>& areas) const;
  [[nodiscard]] std::vector<std::pair<Index, Vector3>> normals_at_nodes(Index facet,
                                                                        const std::map<Index, AreaSum>& areas) const;
  [[nodiscard]] Vector3 middle_direction(const Vector3& at, const Vector3& own_direction, const Vector3& faced_normal,
                                         double height, const std::map<Index, AreaSum>* faced) const;
  void make_mortar_points(const MultiplierSpace& space, const AnchorDirections& directions, BodyContact& result) const;
  void make_nodal_points(const MultiplierSpace& space, const AnchorDirections& directions, BodyContact& result) const;
  void remove_supported(const FreeComponent& is_free, BodyContact& result) const;
  void summarize(bool has_gaps, BodyContact& result) const;
};

/// Computes n_i: the mean of minus the average normal of the facing facets around the anchor, and the normal of the
/// surface that the anchor faces along it. The normals of a single side differ from those of the contact by their angle
/// at the edges of a contact of curved bodies; the difference is of first order in a/R, has the opposite sign on the
/// other side, and would cause friction between equal bodies that are only pressed together.
AnchorDirections BodyPairing::Implementation::find_directions(bool at_facets, PairingSummary& found) const {
  AnchorDirections directions;
  const std::map<Index, AreaSum> faced = areas_around_faced_nodes(surfaces, direct);
  const AnchorDirections faced_directions = faced_normals(at_facets);
  const std::set<Index> own_facing(facing.begin(), facing.end());
  const std::map<Index, AreaSum> own_areas = areas_around_nodes(body, own, &own_facing);
  const auto near = [](const Vector3& reference, const Vector3& found) {
    return (found - reference).norm() > same_direction ? found : reference;
  };
  if (at_facets) {
    for (std::size_t k = 0; k < own.facets().size(); ++k) {
      if (!faces(k)) continue;
      const FacetSurface::Facet& facet = own.facets()[k];
      directions[facet.number] =
          middle_direction(facet.centre, -normal_of(k), faced_directions.at(facet.number), facet.cell_height, nullptr);
    }
    return directions;
  }
  for (const auto& [node, sum] : own_areas) {
    const double agreement = sum.vector.norm() / sum.size;
    if (agreement >= found.agreement) continue;
    found.agreement = agreement;
    found.edge = in_mesh(surfaces.position(node));
  }
  refuse_fold(pair, found);
  // On a flat surface all facets and multipliers have an identical direction.
  for (std::size_t k = 0; k < own.facets().size(); ++k) {
    if (!faces(k)) continue;
    for (const auto& [node, normal] : normals_at_nodes(own.facets()[k].number, own_areas))
      directions.try_emplace(node, near(-normal_of(k), -normal));
  }
  for (auto& [node, direction] : directions) {
    Vector3 at = surfaces.position(node);
    at.head(body.mesh->dimension) += own.shift();
    direction = middle_direction(at, direction, faced_directions.at(node), own.height_at(node), &faced);
  }
  return directions;
}

/// Returns the normals at the nodes of a facet: between vertices the mean of theirs, consistent with the normals of the
/// opposite side.
std::vector<std::pair<Index, Vector3>> BodyPairing::Implementation::normals_at_nodes(
    Index facet, const std::map<Index, AreaSum>& areas) const {
  const IndexInBlocks location = locate_facet(*body.space, facet);
  const CellBlock& block = body.space->facets[location.block];
  std::vector<std::pair<Index, Vector3>> result;
  for (const std::vector<int>& vertices : node_vertices(block.shape, body.space->degree)) {
    Vector3 sum = Vector3::Zero();
    for (const int v : vertices) sum += areas.at(block.cell(location.local)[v]).vector.normalized();
    result.emplace_back(block.cell(location.local)[result.size()], sum.normalized());
  }
  return result;
}

/// Returns for each anchor the mean normal of the facets onto which its facets project along their own normals.
AnchorDirections BodyPairing::Implementation::faced_normals(bool at_facets) const {
  AnchorDirections result;
  for (std::size_t k = 0; k < own.facets().size(); ++k) {
    if (!faces(k)) continue;
    Vector3 sum = Vector3::Zero();
    for (const SurfaceSegment& segment : direct[k].segments)
      sum += segment.weights.sum() * opposite_normal.at(segment.opposite);
    const Index facet = own.facets()[k].number;
    const std::vector<Index> anchors = at_facets ? std::vector{facet} : facet_nodes(*body.space, {facet});
    for (const Index anchor : anchors) result.try_emplace(anchor, Vector3::Zero()).first->second += sum;
  }
  for (auto& [anchor, sum] : result) {
    if (!at_facets) remove_radial_part(body, anchor, sum);
    sum.normalize();
  }
  return result;
}

/// Interpolates the normals at the vertices, which follow from the areas around them.
Vector3 BodyPairing::Implementation::normal_between_nodes(const SegmentFinder::Hit& hit,
                                                          const std::map<Index, AreaSum>& areas) const {
  Matrix values;
  map.hats(hit.facet, hit.local, values);
  const IndexInBlocks location = locate_facet(*body.space, hit.facet);
  const Index* const nodes = body.space->facets[location.block].cell(location.local);
  Vector3 normal = Vector3::Zero();
  for (Index k = 0; k < values.rows(); ++k) {
    const auto around = areas.find(nodes[k]);
    if (around != areas.end()) normal += values(k, 0) * around->second.vector.normalized();
  }
  return normal;
}

/// Returns the mean of the own direction and the normal of the opposite surface at the point hit along this very mean:
/// the normal of the facet there if `faced` is null. Surfaces that are mirror images thus have the normal of the
/// mirror, at any gap; along the own direction another point would be hit, shifted by the gap times its slope. If the
/// iterations find no such point, the point hit along the own direction is used, or that direction alone.
Vector3 BodyPairing::Implementation::middle_direction(const Vector3& at, const Vector3& own_direction,
                                                      const Vector3& faced_normal, double height,
                                                      const std::map<Index, AreaSum>* faced) const {
  constexpr int max_iterations = 30;
  const auto from = [&](const Vector3& direction) -> std::optional<Vector3> {
    SegmentFinder::Hit hit = finder.find_point(at, direction, 0.5 * height);
    if (hit.facet < 0) hit = finder.find_point(at, direction, 0.5 * height, beyond_rim);
    if (hit.facet < 0) return {};
    const Vector3 normal = faced != nullptr ? normal_between_nodes(hit, *faced) : opposite_normal.at(hit.facet);
    if (!(normal.dot(own_direction) > 0.0)) return {};
    return (own_direction + normal.normalized()).normalized();
  };
  std::optional<Vector3> direction = (own_direction + faced_normal).normalized();
  for (int iteration = 0; iteration < max_iterations && direction; ++iteration) {
    const std::optional<Vector3> next = from(*direction);
    if (next && (*next - *direction).norm() <= same_direction)
      return (*next - own_direction).norm() > same_direction ? *next : own_direction;
    direction = next;
  }
  direction = from(own_direction);
  return direction && (*direction - own_direction).norm() > same_direction ? *direction : own_direction;
}

void BodyPairing::Implementation::make_mortar_points(const MultiplierSpace& space, const AnchorDirections& directions,
                                                     BodyContact& result) const {
  PairIntegration integration(body, map, own, finder, space, directions);
  for (std::size_t k = 0; k < own.facets().size(); ++k) {
    if (faces(k)) integration.add_facet(int(k), normal_of(k), direct[k]);
  }
  result.facing.lost = integration.lost();
  const bool at_facets = anchor_of(pair.multipliers) == MultiplierAnchor::facet;
  const bool by_quadrature = body.mesh->degree > body.space->degree;
  for (const auto& [anchor, sums] : integration.sums()) {
    if (!(sums.weight > least_cover * sums.whole)) {
      ++result.facing.uncovered;
      continue;
    }
    result.multipliers.push_back({space.patch().parts.front().pair, at_facets ? -1 : anchor, at_facets ? anchor : -1,
                                  sums.weight, fractions(sums.own, sums.weight)});
    PointConditions conditions{in_mesh(directions.at(anchor)), fractions(sums.opposite, sums.weight), 0.0, 0.0};
    if (by_quadrature) conditions.gap = sums.gap / sums.weight;
    result.conditions.push_back(std::move(conditions));
  }
}

/// Nodal forces: pairs each node with its projection onto the other surface.
void BodyPairing::Implementation::make_nodal_points(const MultiplierSpace& space, const AnchorDirections& directions,
                                                    BodyContact& result) const {
  constexpr double at_node = 1e-6;
  for (Multiplier multiplier : space.multipliers()) {
    const BodyContact::Node facing = surfaces.node_facing(multiplier.node, true, directions.at(multiplier.node));
    if (facing.opposite.empty()) {
      ++result.facing.uncovered;
      continue;
    }
    const bool matches =
        std::ranges::any_of(facing.opposite, [](const auto& entry) { return entry.second > 1.0 - at_node; });
    result.facing.matches = result.facing.matches && matches;
    result.conditions.push_back({facing.normal, facing.opposite, facing.gap, 0.0});
    result.multipliers.push_back(std::move(multiplier));
  }
}

/// Removes points that can only act on supports, on both sides.
void BodyPairing::Implementation::remove_supported(const FreeComponent& is_free, BodyContact& result) const {
  result.facing.held = result.keep([&](const Multiplier& multiplier, const PointConditions& conditions) {
    const auto is_free_here = [&](const auto& entry) { return has_free_part(entry.first, conditions.normal, is_free); };
    return std::ranges::any_of(multiplier.trace, is_free_here) ||
           std::ranges::any_of(conditions.opposite, is_free_here);
  });
}

/// Computes gaps and their rounding, and the statistics of the pairing.
void BodyPairing::Implementation::summarize(bool has_gaps, BodyContact& result) const {
  const double size = extent(body.space->nodes);
  double height = std::numeric_limits<double>::infinity();
  for (const FacetSurface::Facet& facet : own.facets()) height = std::min(height, facet.cell_height);
  const auto closes = [&](double gap) { return gap < 0.0 && (pair.closed_gaps || gap > -rounding_of_files * height); };
  PairingSummary& facing = result.facing;
  facing.points = Index(result.multipliers.size());
  for (std::size_t i = 0; i < result.multipliers.size(); ++i) {
    PointConditions& point = result.conditions[i];
    Vector apart = Vector::Zero(body.mesh->dimension);
    double lengths = 0.0;
    const auto add = [&](const NodeWeights& weights, double sign) {
      for (const auto& [node, weight] : weights) {
        const Vector at = body.space->nodes.col(node);
        apart += sign * weight * at;
        lengths += std::abs(weight) * (at.lpNorm<1>() + size);
      }
    };
    add(result.multipliers[i].trace, 1.0);
    add(point.opposite, -1.0);
    if (!has_gaps) point.gap = point.normal.dot(apart);
    point.gap_rounding = 8.0 * std::numeric_limits<double>::epsilon() * lengths;
    if (point.gap < facing.smallest_gap) {
      facing.smallest_gap = point.gap;
      facing.gap_rounding = point.gap_rounding;
    }
    facing.largest_gap = std::max(facing.largest_gap, point.gap);
    if (!closes(point.gap)) continue;
    if (point.gap < -point.gap_rounding) ++facing.closed;
    point.gap = 0.0;
  }
  for (BodyContact::Node& node : result.nodes) {
    if (closes(node.gap)) node.gap = 0.0;
  }
  for (std::size_t k = 0; k < own.facets().size(); ++k) {
    const double ring = is_axisymmetric(body) ? ring_length(own.facets()[k].centre[0]) : 1.0;
    const double area = own.facets()[k].area * ring;
    facing.area += area;
    facing.covered += std::min(direct[k].covered, 1.0) * area;
    constexpr double least = 1e-3;
    if (direct[k].covered > least && direct[k].covered < 1.0 - least) facing.partly_covered += direct[k].covered * area;
  }
}

BodyPairing::BodyPairing(const Body& body, const ContactPair& pair)
    : implementation_(std::make_unique<Implementation>(body, pair)) {}

BodyPairing::~BodyPairing() = default;

const std::vector<Index>& BodyPairing::facing_facets() const { return implementation_->facing; }

BodyContact BodyPairing::make(const MultiplierSpace& space, const FreeComponent& is_free) const {
  const Implementation& own = *implementation_;
  BodyContact result;
  const bool at_facets = anchor_of(own.pair.multipliers) == MultiplierAnchor::facet;
  const AnchorDirections directions = own.find_directions(at_facets, result.facing);
  if (space.has_functions()) {
    own.make_mortar_points(space, directions, result);
  } else {
    own.make_nodal_points(space, directions, result);
  }
  own.remove_supported(is_free, result);
  result.nodes = nodes_of_points(own.surfaces, own.direct, at_facets ? AnchorDirections{} : directions, result);
  result.opposite_recovery = opposite_pressure(own.surfaces, own.direct, space, result.multipliers);
  own.summarize(space.has_functions() && own.body.mesh->degree > own.body.space->degree, result);
  return result;
}

}  // namespace ricochet
