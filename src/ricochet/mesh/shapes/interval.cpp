#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

CellShapeDescription describe_interval() {
  CellShapeDescription cell = product_of_simplices(CellShape::interval, {1});
  cell.edges = {{0, 1}};
  cell.file_vertices = {0, 1};
  cell.gmsh = cell.vtk = {{{0, 1}}};
  cell.file_types = {{{1, 3, "Polyline", 2, "line"}, {8, 21, "Edge_3", 34, "line3"}}};
  return cell;
}

}  // namespace ricochet
