#pragma once

#include <string>
#include <vector>

/// @file Shapes of cells and facets. Vertices and nodes are numbered as in Basix: lexicographically on quadrilaterals
/// and hexahedra (the bits of k are the reference coordinates of vertex k), and 0, e₁, e₂, e₃ on simplices.
namespace ricochet {

/// Applies `shape` to the name of each cell shape, in the order of the blocks of a mesh. The file `NAME.cpp` of this
/// folder describes the shape: it defines `CellShapeDescription describe_NAME()`.
#define RICOCHET_CELL_SHAPES(shape) \
  shape(interval) shape(triangle) shape(quadrilateral) shape(tetrahedron) shape(hexahedron)

#define RICOCHET_ENUMERATE_SHAPE(shape) shape,
enum class CellShape { RICOCHET_CELL_SHAPES(RICOCHET_ENUMERATE_SHAPE) };
#undef RICOCHET_ENUMERATE_SHAPE

/// Returns all shapes, in their order.
[[nodiscard]] const std::vector<CellShape>& cell_shapes();
[[nodiscard]] int dimension(CellShape shape);
[[nodiscard]] int vertex_count(CellShape shape);
/// Returns true for intervals, triangles and tetrahedra.
[[nodiscard]] bool is_simplex(CellShape shape);
/// Returns "triangle", "quadrilateral", …
[[nodiscard]] std::string name(CellShape shape);
/// Returns "triangles", "tetrahedra", …
[[nodiscard]] std::string plural_name(CellShape shape);
/// Returns the plural names of the shapes of dimension 2 and 3, for messages: "triangles, quadrilaterals, … or …".
[[nodiscard]] std::string names_of_cells(bool with_simplices = true);

}  // namespace ricochet
