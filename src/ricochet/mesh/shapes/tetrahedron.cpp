#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

CellShapeDescription describe_tetrahedron() {
  CellShapeDescription cell = product_of_simplices(CellShape::tetrahedron, {3});
  cell.edges = {{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}};
  cell.facets = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  cell.file_vertices = {0, 1, 2, 3};
  cell.gmsh = {{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
  cell.vtk = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  cell.file_types = {{{4, 10, "Tetrahedron", 6, "tetra"}, {11, 24, "Tet_10", 38, "tetra10"}}};
  cell.abaqus_facets = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  cell.exodus_sides = {1, 2, 3, 0};
  return cell;
}

}  // namespace ricochet
