#include "ricochet/contact/mortar/paired_surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;

/// Degree of the rule on segments. On straight simplices products of two shape functions are polynomials of the
/// position. On quadrilaterals they are rational functions, and the rule is exact to nine digits
/// (body_contact_test.cpp). On curved facets areas are those of the flat pieces, accurate to the order of the geometry.
int segment_degree(const Body& body) {
  const bool simplices =
      std::ranges::all_of(body.mesh->facets, [](const CellBlock& block) { return is_simplex(block.shape); });
  if (!simplices) return 2 * body.space->degree + 8;
  const int degree = 2 * body.space->degree + (body.mesh->degree == 1 ? 0 : 2);
  return is_axisymmetric(body) ? degree + body.mesh->degree : degree;  // for the distance from the axis
}

}  // namespace

void remove_radial_part(const Body& body, Index node, Eigen::Vector3d& vector) {
  if (is_on_axis(body, node)) vector[0] = 0.0;
}

NodeWeights fractions(const std::map<Index, double>& sums, double weight) {
  double largest = 0.0;
  for (const auto& [node, value] : sums) largest = std::max(largest, std::abs(value));
  NodeWeights result;
  for (const auto& [node, value] : sums) {
    const bool vanishes = std::abs(value) <= 64.0 * std::numeric_limits<double>::epsilon() * largest;
    result.emplace_back(node, vanishes ? 0.0 : value / weight);
  }
  return result;
}

FacetsAround facets_around_nodes(const DisplacementSpace& space, const std::vector<Index>& facets) {
  FacetsAround result;
  for (const Index facet : facets) {
    for (const Index node : facet_nodes(space, {facet})) result[node].push_back(facet);
  }
  return result;
}

std::map<Index, AreaSum> areas_around_nodes(const Body& body, const FacetSurface& surface,
                                            const std::set<Index>* only) {
  std::map<Index, AreaSum> result;
  for (const FacetSurface::Facet& facet : surface.facets()) {
    if (only != nullptr && !only->contains(facet.number)) continue;
    const IndexInBlocks location = locate_facet(*body.space, facet.number);
    const CellBlock& block = body.space->facets[location.block];
    for (int k = 0; k < block.nodes_per_cell; ++k) {
      AreaSum& sum = result[block.cell(location.local)[k]];
      sum.vector += facet.area_vector;
      sum.size += facet.area;
    }
  }
  for (auto& [node, sum] : result) remove_radial_part(body, node, sum.vector);
  return result;
}

PairedSurfaces::PairedSurfaces(const Body& of_body, const ContactPair& pair)
    : body(of_body),
      map(of_body),
      own(of_body, pair.facets, pair.pair_at),
      opposite(of_body, pair.opposite_facets),
      finder(map, own, opposite, segment_degree(of_body)),
      back(map, opposite, own, segment_degree(of_body)) {}

Vector3 PairedSurfaces::position(Index node) const {
  Vector3 result = Vector3::Zero();
  result.head(body.mesh->dimension) = body.space->nodes.col(node);
  return result;
}

BodyContact::Node PairedSurfaces::node_facing(Index node, bool is_own, const Vector3& direction) const {
  const FacetSurface& surface = is_own ? own : opposite;
  Vector3 at = position(node);
  at.head(body.mesh->dimension) += surface.shift();
  BodyContact::Node result{
      node, is_own, direction.head(body.mesh->dimension), std::numeric_limits<double>::quiet_NaN(), {}};
  const double height = surface.height_at(node);
  const SegmentFinder::Hit hit = (is_own ? finder : back).find_point(at, direction, 0.5 * height);
  if (hit.facet < 0) return result;
  Matrix values;
  map.displacement(hit.facet, hit.local, values);
  const IndexInBlocks location = locate_facet(*body.space, hit.facet);
  const Index* const nodes = body.space->facets[location.block].cell(location.local);
  Vector gap_vector = body.space->nodes.col(node);
  std::map<Index, double> sums;
  for (Index k = 0; k < values.rows(); ++k) sums[nodes[k]] += values(k, 0);
  result.opposite = fractions(sums, 1.0);
  for (const auto& [other, weight] : result.opposite) gap_vector -= weight * body.space->nodes.col(other);
  result.gap = result.normal.dot(gap_vector);
  return result;
}

}  // namespace ricochet
