#pragma once

#include <string>

#include "ricochet/base/types.hpp"

/// @file Shapes of cells and facets. Vertices and nodes are numbered as in Basix: lexicographically on quadrilaterals
/// and hexahedra (the bits of k are the reference coordinates of vertex k), and 0, e₁, e₂, e₃ on simplices.
namespace ricochet {

enum class CellShape { interval, triangle, quadrilateral, tetrahedron, hexahedron };

[[nodiscard]] int dimension(CellShape shape);
[[nodiscard]] int vertex_count(CellShape shape);
/// Number of nodes of the Lagrange element of degree 1 or 2 (the full one: 9 on a quadrilateral, 27 on a hexahedron).
[[nodiscard]] int node_count(CellShape shape, int degree);
/// Returns "triangle", "quadrilateral", …
[[nodiscard]] std::string name(CellShape shape);

}  // namespace ricochet
