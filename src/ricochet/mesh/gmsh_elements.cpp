#include "ricochet/mesh/gmsh_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet::gmsh {

namespace {

using VertexSets = std::vector<std::vector<int>>;

// Degrees above 2 and the other shapes are listed only to be refused by name; their node counts let the binary formats
// be read past them, so that the message can count them.
const std::vector<ElementType>& element_types() {
  static const std::vector<ElementType> types{
      {1, "2-node line", 1, 1, 2, CellShape::interval},
      {2, "3-node triangle", 2, 1, 3, CellShape::triangle},
      {3, "4-node quadrilateral", 2, 1, 4, CellShape::quadrilateral},
      {4, "4-node tetrahedron", 3, 1, 4, CellShape::tetrahedron},
      {5, "8-node hexahedron", 3, 1, 8, CellShape::hexahedron},
      {6, "6-node prism", 3, 1, 6, {}},
      {7, "5-node pyramid", 3, 1, 5, {}},
      {8, "3-node line", 1, 2, 3, CellShape::interval},
      {9, "6-node triangle", 2, 2, 6, CellShape::triangle},
      {10, "9-node quadrilateral", 2, 2, 9, CellShape::quadrilateral},
      {11, "10-node tetrahedron", 3, 2, 10, CellShape::tetrahedron},
      {12, "27-node hexahedron", 3, 2, 27, CellShape::hexahedron},
      {13, "18-node prism", 3, 2, 18, {}},
      {14, "14-node pyramid", 3, 2, 14, {}},
      {15, "point", 0, 0, 1, {}},
      {16, "8-node quadrilateral", 2, 2, 8, {}},
      {17, "20-node hexahedron", 3, 2, 20, {}},
      {18, "15-node prism", 3, 2, 15, {}},
      {19, "13-node pyramid", 3, 2, 13, {}},
      {20, "9-node triangle", 2, 3, 9, {}},
      {21, "10-node triangle", 2, 3, 10, {}},
      {22, "12-node triangle", 2, 4, 12, {}},
      {23, "15-node triangle of degree 4", 2, 4, 15, {}},
      {24, "15-node triangle of degree 5", 2, 5, 15, {}},
      {25, "21-node triangle", 2, 5, 21, {}},
      {26, "4-node line", 1, 3, 4, {}},
      {27, "5-node line", 1, 4, 5, {}},
      {28, "6-node line", 1, 5, 6, {}},
      {29, "20-node tetrahedron", 3, 3, 20, {}},
      {30, "35-node tetrahedron", 3, 4, 35, {}},
      {31, "56-node tetrahedron", 3, 5, 56, {}},
      {34, "polygon", 2, 1, 0, {}},
      {35, "polyhedron", 3, 1, 0, {}},
      {36, "16-node quadrilateral", 2, 3, 16, {}},
      {37, "25-node quadrilateral", 2, 4, 25, {}},
      {38, "36-node quadrilateral", 2, 5, 36, {}},
      {39, "12-node quadrilateral", 2, 3, 12, {}},
      {90, "40-node prism", 3, 3, 40, {}},
      {91, "75-node prism", 3, 4, 75, {}},
      {92, "64-node hexahedron", 3, 3, 64, {}},
      {93, "125-node hexahedron", 3, 4, 125, {}},
      {118, "30-node pyramid", 3, 3, 30, {}},
      {119, "55-node pyramid", 3, 4, 55, {}},
  };
  return types;
}

/// Like node_vertices, but in Gmsh's numbering of vertices and nodes (Gmsh's reference manual, "Node ordering").
VertexSets gmsh_node_vertices(CellShape shape, int degree) {
  VertexSets nodes;
  for (int vertex = 0; vertex < vertex_count(shape); ++vertex) nodes.push_back({vertex});
  if (degree == 1) return nodes;
  VertexSets higher;
  switch (shape) {
    case CellShape::interval:
      higher = {{0, 1}};
      break;
    case CellShape::triangle:
      higher = {{0, 1}, {1, 2}, {2, 0}};
      break;
    case CellShape::quadrilateral:
      higher = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}};
      break;
    case CellShape::tetrahedron:
      higher = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}};
      break;
    case CellShape::hexahedron:
      higher = {{0, 1},
                {0, 3},
                {0, 4},
                {1, 2},
                {1, 5},
                {2, 3},
                {2, 6},
                {3, 7},
                {4, 5},
                {4, 7},
                {5, 6},
                {6, 7},
                {0, 3, 2, 1},
                {0, 1, 5, 4},
                {0, 4, 7, 3},
                {1, 2, 6, 5},
                {2, 3, 7, 6},
                {4, 5, 6, 7},
                {0, 1, 2, 3, 4, 5, 6, 7}};
      break;
  }
  nodes.insert(nodes.end(), higher.begin(), higher.end());
  return nodes;
}

/// Basix's number of the vertex that Gmsh numbers `vertex`: Gmsh numbers quadrilaterals around their boundary, Basix
/// lexicographically.
int basix_vertex(CellShape shape, int vertex) {
  constexpr std::array<int, 8> around{0, 1, 3, 2, 4, 5, 7, 6};
  const bool tensor = shape == CellShape::quadrilateral || shape == CellShape::hexahedron;
  return tensor ? around[static_cast<std::size_t>(vertex)] : vertex;
}

std::vector<int> make_node_order(CellShape shape, int degree) {
  VertexSets gmsh_nodes = gmsh_node_vertices(shape, degree);
  for (std::vector<int>& vertices : gmsh_nodes) {
    for (int& vertex : vertices) vertex = basix_vertex(shape, vertex);
    std::sort(vertices.begin(), vertices.end());
  }
  std::vector<int> order;
  for (const std::vector<int>& vertices : node_vertices(shape, degree)) {
    const auto found = std::find(gmsh_nodes.begin(), gmsh_nodes.end(), vertices);
    order.push_back(static_cast<int>(found - gmsh_nodes.begin()));
  }
  return order;
}

}  // namespace

const ElementType* find_element_type(int number) {
  const std::vector<ElementType>& types = element_types();
  const auto found = std::lower_bound(types.begin(), types.end(), number,
                                      [](const ElementType& type, int target) { return type.number < target; });
  return found != types.end() && found->number == number ? &*found : nullptr;
}

std::string describe_type(int number) {
  const ElementType* type = find_element_type(number);
  return fmt::format("type {} ({})", number, type != nullptr ? type->name : "unknown to Ricochet");
}

const std::vector<int>& node_order(CellShape shape, int degree) {
  static const auto table = [] {
    std::array<std::vector<int>, 10> orders;
    for (std::size_t i = 0; i < orders.size(); ++i) {
      orders[i] = make_node_order(static_cast<CellShape>(i / 2), static_cast<int>(i % 2) + 1);
    }
    return orders;
  }();
  return table[2 * static_cast<std::size_t>(shape) + (degree == 1 ? 0 : 1)];
}

}  // namespace ricochet::gmsh
