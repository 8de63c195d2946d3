#include "ricochet/mesh/cell_type.hpp"

namespace ricochet {

int dimension(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return 1;
    case CellShape::triangle:
    case CellShape::quadrilateral:
      return 2;
    case CellShape::tetrahedron:
    case CellShape::hexahedron:
      return 3;
  }
  return 0;
}

int vertex_count(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return 2;
    case CellShape::triangle:
      return 3;
    case CellShape::quadrilateral:
      return 4;
    case CellShape::tetrahedron:
      return 4;
    case CellShape::hexahedron:
      return 8;
  }
  return 0;
}

int node_count(CellShape shape, int degree) {
  if (degree == 1) return vertex_count(shape);
  switch (shape) {
    case CellShape::interval:
      return 3;
    case CellShape::triangle:
      return 6;
    case CellShape::quadrilateral:
      return 9;
    case CellShape::tetrahedron:
      return 10;
    case CellShape::hexahedron:
      return 27;
  }
  return 0;
}

std::string name(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return "interval";
    case CellShape::triangle:
      return "triangle";
    case CellShape::quadrilateral:
      return "quadrilateral";
    case CellShape::tetrahedron:
      return "tetrahedron";
    case CellShape::hexahedron:
      return "hexahedron";
  }
  return "";
}

}  // namespace ricochet
