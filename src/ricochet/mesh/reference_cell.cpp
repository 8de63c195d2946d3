#include "ricochet/mesh/reference_cell.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <stdexcept>

#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

namespace {

template <class Value>
int index_of(const std::vector<Value>& all, const Value& one) {
  return int(std::ranges::find(all, one) - all.begin());
}

/// Renumbers vertices and sorts them.
VertexSet renumbered(const VertexSet& set, const std::vector<int>& numbers) {
  VertexSet result;
  for (const int vertex : set) result.push_back(numbers[std::size_t(vertex)]);
  std::ranges::sort(result);
  return result;
}

VertexSet all_vertices(CellShape shape) {
  VertexSet result(static_cast<std::size_t>(vertex_count(shape)));
  std::iota(result.begin(), result.end(), 0);
  return result;
}

/// Basix numbers nodes by the dimension of what they lie on: vertices, edges, facets, the cell.
VertexSets make_node_vertices(CellShape shape, int degree) {
  const CellShapeDescription& cell = describe(shape);
  VertexSets nodes;
  for (int vertex = 0; vertex < vertex_count(shape); ++vertex) nodes.push_back({vertex});
  if (degree == 1) return nodes;
  nodes.insert(nodes.end(), cell.edges.begin(), cell.edges.end());
  for (std::size_t facet = 0; facet < cell.facets.size(); ++facet) {
    if (describe(facet_shape(shape, facet)).has_centre_node) nodes.push_back(cell.facets[facet]);
  }
  if (cell.has_centre_node) nodes.push_back(all_vertices(shape));
  return nodes;
}

VertexSets make_facet_nodes(CellShape shape, int degree) {
  VertexSets result;
  for (const VertexSet& facet : describe(shape).facets) {
    std::vector<int>& nodes = result.emplace_back();
    for (const VertexSet& local : node_vertices(facet_shape(shape, result.size() - 1), degree))
      nodes.push_back(index_of(node_vertices(shape, degree), renumbered(local, facet)));
  }
  return result;
}

VertexSets make_outward_facet_vertices(CellShape shape) {
  VertexSets result;
  const Eigen::Vector3d centre = reference_position(shape, all_vertices(shape));
  for (const VertexSet& facet : describe(shape).facets) {
    VertexSet& around = result.emplace_back();
    for (const int vertex : describe(facet_shape(shape, result.size() - 1)).file_vertices)
      around.push_back(facet[std::size_t(vertex)]);
    const Eigen::Vector3d first = reference_position(shape, {around[0]});
    const Eigen::Vector3d along = reference_position(shape, {around[1]}) - first;
    const Eigen::Vector3d across = around.size() == 2
                                       ? Eigen::Vector3d::UnitZ()
                                       : Eigen::Vector3d(reference_position(shape, {around.back()}) - first);
    if (along.cross(across).dot(first - centre) < 0.0) std::ranges::reverse(around);
  }
  return result;
}

/// With the vector n of a facet, twice its area long in 3D, the sum S of |det| over the simplices, and p on the facet,
/// the height is d max|n·(x − p)|/S volumes per area. All are small integers, so that the result is exact.
std::vector<double> make_facet_heights(CellShape shape) {
  const CellShapeDescription& cell = describe(shape);
  double volumes = 0.0;
  for (const VertexSet& simplex : cell.simplices) {
    Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
    for (int k = 0; k < cell.dimension; ++k)
      edges.col(k) = reference_position(shape, {simplex[std::size_t(k) + 1]}) - reference_position(shape, {simplex[0]});
    volumes += std::abs(edges.determinant());
  }
  std::vector<double> result;
  for (const VertexSet& facet : outward_facet_vertices(shape)) {
    const Eigen::Vector3d first = reference_position(shape, {facet[0]});
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (std::size_t k = 1; k < facet.size(); ++k) {
      const Eigen::Vector3d at = reference_position(shape, {facet[k]}) - first;
      normal += at.cross(facet.size() == 2 ? Eigen::Vector3d::UnitZ()
                                           : Eigen::Vector3d(reference_position(shape, {facet[k - 1]}) - first));
    }
    double highest = 0.0;
    for (const Eigen::Vector3d& vertex : cell.vertices)
      highest = std::max(highest, std::abs(normal.dot(vertex - first)));
    result.push_back(cell.dimension * highest / volumes);
  }
  return result;
}

std::vector<int> make_mirrored_nodes(CellShape shape, int degree) {
  std::vector<int> mirrored_vertex;
  for (Eigen::Vector3d vertex : describe(shape).vertices) {
    std::swap(vertex[0], vertex[1]);
    mirrored_vertex.push_back(index_of(describe(shape).vertices, vertex));
  }
  const VertexSets& nodes = node_vertices(shape, degree);
  std::vector<int> result;
  if (dimension(shape) == 1) return result;
  for (const VertexSet& vertices : nodes) result.push_back(index_of(nodes, renumbered(vertices, mirrored_vertex)));
  return result;
}

std::vector<int> nodes_of_file(CellShape shape, int degree, const FileNodes& further, const VertexSet& own = {}) {
  const std::vector<int>& vertices = describe(shape).file_vertices;
  std::vector<int> result = own.empty() ? vertices : own;
  if (degree == 1) return result;
  for (const VertexSets* all : {&further.edges, &further.faces}) {
    for (const VertexSet& node : *all) result.push_back(node_at_mean(shape, renumbered(node, vertices)));
  }
  if (describe(shape).has_centre_node) result.push_back(node_at_mean(shape, vertices));
  return result;
}

}  // namespace

const VertexSets& node_vertices(CellShape shape, int degree) {
  static const ShapeTable table(make_node_vertices);
  return table.at(shape, degree);
}

int node_count(CellShape shape, int degree) { return int(node_vertices(shape, degree).size()); }

int node_at_mean(CellShape shape, std::vector<int> vertices) {
  std::ranges::sort(vertices);
  return index_of(node_vertices(shape, 2), vertices);
}

int degree_of(CellShape shape, int nodes) { return nodes == vertex_count(shape) ? 1 : 2; }

CellShape facet_shape(CellShape shape, std::size_t facet) {
  const auto fits = [&](CellShape each) {
    return dimension(each) == dimension(shape) - 1 &&
           describe(each).vertices.size() == describe(shape).facets[facet].size();
  };
  const auto found = std::find_if(cell_shapes().begin(), cell_shapes().end(), fits);
  if (found == cell_shapes().end())
    throw std::logic_error("no cell shape is like facet " + std::to_string(facet) + " of a " + name(shape));
  return *found;
}

const VertexSets& facet_nodes(CellShape shape, int degree) {
  static const ShapeTable table(make_facet_nodes);
  return table.at(shape, degree);
}

const VertexSets& outward_facet_vertices(CellShape shape) {
  static const ShapeTable table([](CellShape of, int) { return make_outward_facet_vertices(of); });
  return table.at(shape, 1);
}

const std::vector<double>& facet_heights(CellShape shape) {
  static const ShapeTable table([](CellShape of, int) { return make_facet_heights(of); });
  return table.at(shape, 1);
}

const std::vector<int>& mirrored_nodes(CellShape shape, int degree) {
  static const ShapeTable table(make_mirrored_nodes);
  return table.at(shape, degree);
}

Eigen::Vector3d reference_position(CellShape shape, const std::vector<int>& vertices) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int vertex : vertices) sum += describe(shape).vertices[std::size_t(vertex)];
  return sum / double(vertices.size());
}

const std::vector<int>& gmsh_nodes(CellShape shape, int degree) {
  static const ShapeTable table([](CellShape of, int k) { return nodes_of_file(of, k, describe(of).gmsh); });
  return table.at(shape, degree);
}

const std::vector<int>& vtk_nodes(CellShape shape, int degree) {
  static const ShapeTable table(
      [](CellShape of, int k) { return nodes_of_file(of, k, describe(of).vtk, file_type(of, k).vtk_vertices); });
  return table.at(shape, degree);
}

const std::vector<int>& meshio_nodes(CellShape shape, int degree) {
  static const ShapeTable table([](CellShape of, int k) { return nodes_of_file(of, k, describe(of).vtk); });
  return table.at(shape, degree);
}

}  // namespace ricochet
