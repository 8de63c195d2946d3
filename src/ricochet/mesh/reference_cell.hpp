#pragma once

#include <vector>

#include "ricochet/mesh/cell_type.hpp"

/// @file Nodes and facets of the reference cells in Basix's numbering, described by vertices only.
namespace ricochet {

/// For each node of the Lagrange element of degree 1 or 2, the vertices (ascending) at whose mean it lies on a straight
/// cell: a vertex, the ends of an edge, the vertices of a quadrilateral face or of the whole quadrilateral or
/// hexahedron.
[[nodiscard]] const std::vector<std::vector<int>>& node_vertices(CellShape shape, int degree);

/// Node of the element of degree 2 at the mean of these vertices, given in any order.
[[nodiscard]] int node_at_mean(CellShape shape, std::vector<int> vertices);

/// Degree of the Lagrange element with so many nodes, 1 or 2.
[[nodiscard]] int degree_of(CellShape shape, int nodes);

/// Shape of the facets; all supported shapes have facets of a single shape. Not for intervals.
[[nodiscard]] CellShape facet_shape(CellShape shape);

/// For each facet of the cell, in Basix's order, the cell's nodes on it, in the order in which the facet itself numbers
/// its nodes.
[[nodiscard]] const std::vector<std::vector<int>>& facet_nodes(CellShape shape, int degree);

/// For each facet of a cell with positive Jacobian, in Basix's order, its vertices in outward orientation: the cell is
/// on the left of an edge, and a face is counterclockwise seen from outside.
[[nodiscard]] const std::vector<std::vector<int>>& outward_facet_vertices(CellShape shape);

/// For each node its mirror image when the first two reference axes are exchanged: in this order the nodes of a cell
/// give it the opposite orientation. Not for intervals.
[[nodiscard]] const std::vector<int>& mirrored_nodes(CellShape shape, int degree);

/// Reference coordinates of a vertex, each 0 or 1.
[[nodiscard]] double vertex_coordinate(CellShape shape, int vertex, int axis);

}  // namespace ricochet
