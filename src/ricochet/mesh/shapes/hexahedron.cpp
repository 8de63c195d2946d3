#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

CellShapeDescription describe_hexahedron() {
  CellShapeDescription cell = product_of_simplices(CellShape::hexahedron, {1, 1, 1});
  cell.edges = {{0, 1}, {0, 2}, {0, 4}, {1, 3}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 6}, {5, 7}, {6, 7}};
  cell.facets = {{0, 1, 2, 3}, {0, 1, 4, 5}, {0, 2, 4, 6}, {1, 3, 5, 7}, {2, 3, 6, 7}, {4, 5, 6, 7}};
  cell.file_vertices = {0, 1, 3, 2, 4, 5, 7, 6};
  cell.gmsh.edges = {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
  cell.gmsh.faces = {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}};
  cell.vtk.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  cell.vtk.faces = {{0, 3, 7, 4}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 2, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};
  cell.file_types = {{{5, 12, "Hexahedron", 9, "hexahedron"}, {12, 29, "Hex_27", 50, "hexahedron27"}}};
  cell.abaqus_facets = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
  cell.exodus_sides = {2, 3, 4, 5, 0, 1};
  return cell;
}

}  // namespace ricochet
