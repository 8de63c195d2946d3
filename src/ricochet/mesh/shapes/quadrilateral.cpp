#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

CellShapeDescription describe_quadrilateral() {
  CellShapeDescription cell = product_of_simplices(CellShape::quadrilateral, {1, 1});
  cell.edges = {{0, 1}, {0, 2}, {1, 3}, {2, 3}};
  cell.facets = cell.edges;
  cell.file_vertices = {0, 1, 3, 2};
  cell.gmsh = cell.vtk = {{{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  cell.file_types = {{{3, 9, "Quadrilateral", 5, "quad"}, {10, 28, "Quad_9", 35, "quad9"}}};
  cell.abaqus_facets = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  cell.exodus_sides = {0, 1, 2, 3};
  return cell;
}

}  // namespace ricochet
