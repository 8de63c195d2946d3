#include "ricochet/contact/sliding/rim_distance.hpp"

#include <algorithm>

#include "ricochet/fem/displacement_space.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/search/closest_point.hpp"

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;
using Vertices = std::array<Index, 2>;

/// Edges of a facet by their vertices, ascending; in 2D its ends.
std::vector<Vertices> edges_of(const DisplacementSpace& space, Index facet) {
  const IndexInBlocks at = locate_facet(space, facet);
  const CellBlock& block = space.facets[at.block];
  const Index* const nodes = block.cell(at.local);
  if (space.dimension == 2) return {{nodes[0], nodes[0]}, {nodes[1], nodes[1]}};
  std::vector<Vertices> result;
  for (const std::vector<int>& vertices : outward_facet_vertices(block.shape)) {
    const Index one = nodes[vertices.front()], other = nodes[vertices.back()];
    result.push_back({std::min(one, other), std::max(one, other)});
  }
  return result;
}

Vector3 position_of(const DisplacementSpace& space, Index node) {
  Vector3 result = Vector3::Zero();
  result.head(space.dimension) = space.nodes.col(node);
  return result;
}

}  // namespace

RimDistance::RimDistance(const DisplacementSpace& space, const FacetSurface& surface) {
  std::map<Vertices, std::vector<const FacetSurface::Facet*>> facets_at_edge;
  std::map<Index, std::vector<Index>> facets_at_vertex;
  for (const FacetSurface::Facet& facet : surface.facets()) {
    for (const Vertices& edge : edges_of(space, facet.number)) {
      facets_at_edge[edge].push_back(&facet);
      for (const Index vertex : edge) facets_at_vertex[vertex].push_back(facet.number);
    }
  }
  for (const auto& [edge, of] : facets_at_edge) {
    if (of.size() != 1) continue;
    std::vector<Index> near;
    for (const Index vertex : edge)
      near.insert(near.end(), facets_at_vertex[vertex].begin(), facets_at_vertex[vertex].end());
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    const Edge rim{position_of(space, edge[0]), position_of(space, edge[1]), rim_width * of.front()->size};
    for (const Index facet : near) edges_at_[facet].push_back(rim);
  }
}

RimDistance::Value RimDistance::evaluate(Index facet, const PolynomialMap<3>::Evaluation& reference) const {
  Value result;
  for (const Edge& edge : edges_at_.at(facet)) {
    const Vector3 from_edge = reference.at - closest_on_segment(reference.at, edge.from, edge.to).position;
    const double length = from_edge.norm(), value = length / edge.width;
    if (!(value < result.distance)) continue;
    result.distance = value;
    for (std::size_t k = 0; k < 2; ++k)
      result.slopes[k] = length > 0.0 ? from_edge.dot(reference.slopes[k]) / (length * edge.width) : 0.0;
  }
  return result;
}

/// Multiplied by vectors perpendicular to n, dx_s − dh n − h dn = dx_m + ∂x/∂ξ dξ yields dξ.
Vector3 rim_direction(const PolynomialMap<3>::Evaluation& at, bool plane, const Vector3& n,
                      const RimDistance::Value& to_rim) {
  const auto& [along, across] = at.slopes;
  if (plane) {
    const Vector3 tangent(n[1], -n[0], 0.0);
    return (to_rim.slopes[0] / along.dot(tangent)) * tangent;
  }
  const Vector3 first = across.cross(n), second = n.cross(along);
  return (to_rim.slopes[0] / along.dot(first)) * first + (to_rim.slopes[1] / across.dot(second)) * second;
}

}  // namespace ricochet
