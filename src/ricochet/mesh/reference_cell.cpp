#include "ricochet/mesh/reference_cell.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>

namespace ricochet {

namespace {

using VertexSets = std::vector<std::vector<int>>;

constexpr std::size_t shape_count = 5;

// Basix numbers the edges of simplices by the opposite vertex, and those of tensor cells lexicographically.
VertexSets edges(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return {{0, 1}};
    case CellShape::triangle:
      return {{1, 2}, {0, 2}, {0, 1}};
    case CellShape::quadrilateral:
      return {{0, 1}, {0, 2}, {1, 3}, {2, 3}};
    case CellShape::tetrahedron:
      return {{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}};
    case CellShape::hexahedron:
      return {{0, 1}, {0, 2}, {0, 4}, {1, 3}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 6}, {5, 7}, {6, 7}};
  }
  return {};
}

VertexSets facets(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return {};
    case CellShape::triangle:
    case CellShape::quadrilateral:
      return edges(shape);
    case CellShape::tetrahedron:
      return {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
    case CellShape::hexahedron:
      return {{0, 1, 2, 3}, {0, 1, 4, 5}, {0, 2, 4, 6}, {1, 3, 5, 7}, {2, 3, 6, 7}, {4, 5, 6, 7}};
  }
  return {};
}

VertexSets make_node_vertices(CellShape shape, int degree) {
  VertexSets nodes;
  for (int vertex = 0; vertex < vertex_count(shape); ++vertex) nodes.push_back({vertex});
  if (degree == 1) return nodes;
  for (const std::vector<int>& edge : edges(shape)) nodes.push_back(edge);
  if (shape == CellShape::quadrilateral) nodes.push_back({0, 1, 2, 3});
  if (shape == CellShape::hexahedron) {
    for (const std::vector<int>& face : facets(shape)) nodes.push_back(face);
    nodes.push_back({0, 1, 2, 3, 4, 5, 6, 7});
  }
  return nodes;
}

VertexSets make_facet_nodes(CellShape shape, int degree) {
  VertexSets result;
  if (shape == CellShape::interval) return result;
  const VertexSets& cell_nodes = node_vertices(shape, degree);
  for (const std::vector<int>& facet : facets(shape)) {
    std::vector<int> nodes;
    for (const std::vector<int>& local : node_vertices(facet_shape(shape), degree)) {
      std::vector<int> vertices;
      for (const int vertex : local) vertices.push_back(facet[static_cast<std::size_t>(vertex)]);
      std::sort(vertices.begin(), vertices.end());
      const auto found = std::find(cell_nodes.begin(), cell_nodes.end(), vertices);
      nodes.push_back(static_cast<int>(found - cell_nodes.begin()));
    }
    result.push_back(nodes);
  }
  return result;
}

Eigen::Vector3d vertex_position(CellShape shape, int vertex) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < dimension(shape); ++axis) position(axis) = vertex_coordinate(shape, vertex, axis);
  return position;
}

VertexSets make_outward_facet_vertices(CellShape shape) {
  VertexSets result = facets(shape);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (int vertex = 0; vertex < vertex_count(shape); ++vertex) centre += vertex_position(shape, vertex);
  centre /= vertex_count(shape);
  for (std::vector<int>& facet : result) {
    if (facet.size() == 4) std::swap(facet[2], facet[3]);  // from Basix's row-wise order to one around the facet
    const Eigen::Vector3d first = vertex_position(shape, facet[0]);
    const Eigen::Vector3d along = vertex_position(shape, facet[1]) - first;
    const Eigen::Vector3d across =
        facet.size() == 2 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(vertex_position(shape, facet.back()) - first);
    if (along.cross(across).dot(first - centre) < 0.0) std::reverse(facet.begin(), facet.end());
  }
  return result;
}

std::vector<int> make_mirrored_nodes(CellShape shape, int degree) {
  // The vertices at e₁ and e₂ are 1 and 2 in every shape; those above them in a hexahedron are 5 and 6.
  constexpr std::array<int, 8> mirrored_vertex{0, 2, 1, 3, 4, 6, 5, 7};
  const VertexSets& nodes = node_vertices(shape, degree);
  std::vector<int> result;
  if (shape == CellShape::interval) return result;
  for (std::vector<int> vertices : nodes) {
    for (int& vertex : vertices) vertex = mirrored_vertex[static_cast<std::size_t>(vertex)];
    std::sort(vertices.begin(), vertices.end());
    result.push_back(static_cast<int>(std::find(nodes.begin(), nodes.end(), vertices) - nodes.begin()));
  }
  return result;
}

/// Table with one entry per shape and degree, made at first use: entries are looked up once per block of cells.
template <class Make>
auto make_table(Make make) {
  std::array<decltype(make(CellShape::triangle, 1)), 2 * shape_count> table;
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = make(static_cast<CellShape>(i / 2), static_cast<int>(i % 2) + 1);
  return table;
}

std::size_t table_index(CellShape shape, int degree) {
  return 2 * static_cast<std::size_t>(shape) + (degree == 1 ? 0 : 1);
}

}  // namespace

const VertexSets& node_vertices(CellShape shape, int degree) {
  static const auto table = make_table(make_node_vertices);
  return table[table_index(shape, degree)];
}

int node_at_mean(CellShape shape, std::vector<int> vertices) {
  const VertexSets& all = node_vertices(shape, 2);
  std::sort(vertices.begin(), vertices.end());
  return static_cast<int>(std::find(all.begin(), all.end(), vertices) - all.begin());
}

int degree_of(CellShape shape, int nodes) {
  return nodes == vertex_count(shape) ? 1 : 2;
}

CellShape facet_shape(CellShape shape) {
  switch (shape) {
    case CellShape::tetrahedron:
      return CellShape::triangle;
    case CellShape::hexahedron:
      return CellShape::quadrilateral;
    default:
      return CellShape::interval;
  }
}

const VertexSets& facet_nodes(CellShape shape, int degree) {
  static const auto table = make_table(make_facet_nodes);
  return table[table_index(shape, degree)];
}

const VertexSets& outward_facet_vertices(CellShape shape) {
  static const auto table = make_table([](CellShape of, int) { return make_outward_facet_vertices(of); });
  return table[table_index(shape, 1)];
}

const std::vector<int>& mirrored_nodes(CellShape shape, int degree) {
  static const auto table = make_table(make_mirrored_nodes);
  return table[table_index(shape, degree)];
}

double vertex_coordinate(CellShape shape, int vertex, int axis) {
  const bool simplex = shape == CellShape::triangle || shape == CellShape::tetrahedron;
  const bool one = simplex ? vertex == axis + 1 : ((vertex >> axis) & 1) != 0;
  return one ? 1.0 : 0.0;
}

}  // namespace ricochet
