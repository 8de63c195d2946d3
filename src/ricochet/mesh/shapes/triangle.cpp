#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

CellShapeDescription describe_triangle() {
  CellShapeDescription cell = product_of_simplices(CellShape::triangle, {2});
  cell.edges = {{1, 2}, {0, 2}, {0, 1}};
  cell.facets = cell.edges;
  cell.file_vertices = {0, 1, 2};
  cell.gmsh = cell.vtk = {{{0, 1}, {1, 2}, {2, 0}}};
  cell.file_types = {{{2, 5, "Triangle", 4, "triangle"}, {9, 22, "Tri_6", 36, "triangle6"}}};
  cell.abaqus_facets = {{0, 1}, {1, 2}, {2, 0}};
  cell.exodus_sides = {0, 1, 2};
  return cell;
}

}  // namespace ricochet
