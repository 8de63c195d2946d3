#include "ricochet/contact/sliding/moving_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

namespace {

/// Degree of the rule on segments: exact for products of two shape functions on simplices and on parallelograms.
int degree_on_segments(const Body& body) {
  const bool simplices =
      std::ranges::all_of(body.mesh->facets, [](const CellBlock& block) { return is_simplex(block.shape); });
  return (simplices ? 2 : 4) * body.space->degree;
}

/// Fraction of the initial thickness to which a body may be squeezed. Overlaps up to `deepest_overlap` of that are not
/// attributed to its far side.
constexpr double min_thickness_ratio = 0.5;

/// Mesh of the displacement: isoparametric, for any degree of the geometry.
Mesh mesh_of(const DisplacementSpace& space) {
  Mesh mesh;
  mesh.dimension = space.dimension;
  mesh.degree = space.degree;
  mesh.nodes = space.nodes;
  mesh.cells = space.cells;
  mesh.facets = space.facets;
  return mesh;
}

Body on_mesh(const Body& body, const Mesh& mesh) {
  Body result = body;
  result.mesh = &mesh;
  return result;
}

}  // namespace

MovingSurfaces::MovingSurfaces(const Body& body, const std::vector<Index>& facets,
                               const std::vector<Index>& opposite_facets)
    : reference_body_(body),
      mesh_(mesh_of(*body.space)),
      body_(on_mesh(body, mesh_)),
      reference_(reference_body_),
      map_(body_),
      own_(FacetSurface::moving(body_, facets)),
      opposite_(FacetSurface::moving(body_, opposite_facets)),
      finder_(map_, own_, opposite_, degree_on_segments(body)) {
  std::vector<Index> all = facets;
  all.insert(all.end(), opposite_facets.begin(), opposite_facets.end());
  nodes_ = facet_nodes(*body.space, all);
  moved_by_.setZero(body.space->dof_count());
}

void MovingSurfaces::enable_self_contact() {
  const DisplacementSpace& space = *body_.space;
  std::vector<std::vector<Index>> nodes_of;
  std::map<Index, std::vector<int>> at_node;
  for (const FacetSurface::Facet& facet : own_.facets()) {
    nodes_of.push_back(facet_nodes(space, {facet.number}));
    for (const Index node : nodes_of.back()) at_node[node].push_back(int(nodes_of.size()) - 1);
  }
  const auto widen = [&](const std::vector<int>& facets) {
    std::vector<int> result;
    for (const int facet : facets) {
      for (const Index node : nodes_of[std::size_t(facet)])
        result.insert(result.end(), at_node[node].begin(), at_node[node].end());
    }
    std::ranges::sort(result);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  };
  std::vector<std::vector<int>> ignored_facets;
  std::vector<double> depths;
  for (int facet = 0; facet < int(nodes_of.size()); ++facet) {
    ignored_facets.push_back(widen(widen({facet})));
    const double height = own_.facets()[std::size_t(facet)].cell_height;
    const double thickness = finder_.thickness_behind(facet);
    depths.push_back(std::isfinite(thickness) ? min_thickness_ratio * thickness : height);
  }
  for (const auto& [node, facets] : at_node) ignored_facets_of_[node] = widen(facets);
  facets_at_ = std::move(at_node);
  finder_.set_ignored_facets(std::move(ignored_facets));
  own_.set_depths(depths);
  opposite_.set_depths(depths);
}

double MovingSurfaces::depth_at(Index node) const {
  const auto around = facets_at_.find(node);
  if (around == facets_at_.end()) return own_.height_at(node);
  double least = std::numeric_limits<double>::infinity();
  for (const int facet : around->second) least = std::min(least, own_.facets()[std::size_t(facet)].body_depth);
  return least;
}

const std::vector<int>& MovingSurfaces::ignored_facets_of(Index node) const {
  static const std::vector<int> none;
  const auto found = ignored_facets_of_.find(node);
  return found != ignored_facets_of_.end() ? found->second : none;
}

void MovingSurfaces::move(const Vector& displacement) {
  if (moved_by_ == displacement) return;
  moved_by_ = displacement;
  const Index d = mesh_.dimension;
  for (const Index node : nodes_)
    mesh_.nodes.col(node) = reference_body_.space->nodes.col(node) + displacement.segment(node * d, d);
  own_.move(mesh_.nodes);
  opposite_.move(mesh_.nodes);
}

void MovingSurfaces::scale_to_reference(Index facet, const Points& local, Matrix& values) const {
  const PolynomialMap<3> before = reference_.map_of(facet), now = map_.map_of(facet);
  for (Index q = 0; q < local.cols(); ++q) {
    const double* const at = local.col(q).data();
    values.col(q) *= reference_.density(before.evaluate(at)) / map_.density(now.evaluate(at));
  }
}

Eigen::Vector3d MovingSurfaces::position(Index node) const {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  result.head(mesh_.dimension) = mesh_.nodes.col(node);
  return result;
}

}  // namespace ricochet
