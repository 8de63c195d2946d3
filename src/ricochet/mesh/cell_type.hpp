#pragma once

#include <string>

#include "ricochet/base/types.hpp"

/// @file Shapes of cells and facets. Vertices and nodes are numbered as Basix numbers them: on quadrilaterals and
/// hexahedra lexicographically (vertex k has the reference coordinates given by the bits of k), on simplices 0, e₁, e₂,
/// e₃.
namespace ricochet {

enum class CellShape { interval, triangle, quadrilateral, tetrahedron, hexahedron };

[[nodiscard]] int dimension(CellShape shape);
[[nodiscard]] int vertex_count(CellShape shape);
/// Nodes of the Lagrange element of degree 1 or 2 (the full one: 9 on a quadrilateral, 27 on a hexahedron).
[[nodiscard]] int node_count(CellShape shape, int degree);
/// "triangle", "quadrilateral", …
[[nodiscard]] std::string name(CellShape shape);

}  // namespace ricochet
