#include "ricochet/io/vtk_order.hpp"

#include <algorithm>

#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

using VertexSets = std::vector<std::vector<int>>;

/// Nodes after the vertices, each given by the (VTK) vertices of its entity.
VertexSets vtk_middles(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return {{0, 1}};
    case CellShape::triangle:
      return {{0, 1}, {1, 2}, {0, 2}};
    case CellShape::quadrilateral:
      return {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 1, 2, 3}};
    case CellShape::tetrahedron:
      return {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    case CellShape::hexahedron:
      return {{0, 1},
              {1, 2},
              {2, 3},
              {0, 3},
              {4, 5},
              {5, 6},
              {6, 7},
              {4, 7},
              {0, 4},
              {1, 5},
              {2, 6},
              {3, 7},
              {0, 3, 4, 7},
              {1, 2, 5, 6},
              {0, 1, 4, 5},
              {2, 3, 6, 7},
              {0, 1, 2, 3},
              {4, 5, 6, 7},
              {0, 1, 2, 3, 4, 5, 6, 7}};
  }
  return {};
}

std::vector<int> vtk_vertices(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return {0, 1};
    case CellShape::triangle:
      return {0, 1, 2};
    case CellShape::quadrilateral:
      return {0, 1, 3, 2};
    case CellShape::tetrahedron:
      return {0, 1, 2, 3};
    case CellShape::hexahedron:
      return {0, 1, 3, 2, 4, 5, 7, 6};
  }
  return {};
}

}  // namespace

VtkCell vtk_cell(CellShape shape, int degree) {
  VtkCell result;
  result.from_ours = vtk_vertices(shape);
  switch (shape) {
    case CellShape::interval:
      result.xdmf_name = degree == 1 ? "Polyline" : "Edge_3";
      result.xdmf_number = degree == 1 ? 2 : 34;
      result.vtk_number = degree == 1 ? 3 : 21;
      break;
    case CellShape::triangle:
      result.xdmf_name = degree == 1 ? "Triangle" : "Tri_6";
      result.xdmf_number = degree == 1 ? 4 : 36;
      result.vtk_number = degree == 1 ? 5 : 22;
      break;
    case CellShape::quadrilateral:
      result.xdmf_name = degree == 1 ? "Quadrilateral" : "Quad_9";
      result.xdmf_number = degree == 1 ? 5 : 35;
      result.vtk_number = degree == 1 ? 9 : 28;
      break;
    case CellShape::tetrahedron:
      result.xdmf_name = degree == 1 ? "Tetrahedron" : "Tet_10";
      result.xdmf_number = degree == 1 ? 6 : 38;
      result.vtk_number = degree == 1 ? 10 : 24;
      break;
    case CellShape::hexahedron:
      result.xdmf_name = degree == 1 ? "Hexahedron" : "Hex_27";
      result.xdmf_number = degree == 1 ? 9 : 50;
      result.vtk_number = degree == 1 ? 12 : 29;
      break;
  }
  if (degree == 1) return result;
  const std::vector<int> vertices = result.from_ours;
  const VertexSets& ours = node_vertices(shape, 2);
  for (std::vector<int> set : vtk_middles(shape)) {
    for (int& vertex : set) vertex = vertices[static_cast<std::size_t>(vertex)];
    std::sort(set.begin(), set.end());
    result.from_ours.push_back(static_cast<int>(std::find(ours.begin(), ours.end(), set) - ours.begin()));
  }
  return result;
}

}  // namespace ricochet
