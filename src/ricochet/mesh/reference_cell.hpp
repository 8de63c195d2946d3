#pragma once

#include <vector>

#include "ricochet/mesh/cell_type.hpp"

/// @file The reference cells' nodes and facets, in Basix's numbering, described by vertices only.
namespace ricochet {

/// For each node of the Lagrange element of degree 1 or 2, the vertices (ascending) at whose mean it lies on a straight
/// cell: a vertex, the ends of an edge, the vertices of a quadrilateral face or of the whole quadrilateral or
/// hexahedron.
[[nodiscard]] const std::vector<std::vector<int>>& node_vertices(CellShape shape, int degree);

/// The node of the element of degree 2 at the mean of these vertices, which come in any order.
[[nodiscard]] int node_at_mean(CellShape shape, std::vector<int> vertices);

/// Degree of the Lagrange element with so many nodes, 1 or 2.
[[nodiscard]] int degree_of(CellShape shape, int nodes);

/// Shape of the facets; the shapes supported have facets of one shape only. Not for intervals.
[[nodiscard]] CellShape facet_shape(CellShape shape);

/// For each facet of the cell, in Basix's order, the cell's nodes on it, in the order the facet itself numbers its
/// nodes.
[[nodiscard]] const std::vector<std::vector<int>>& facet_nodes(CellShape shape, int degree);

/// For each facet of the cell, in Basix's order, its vertices as one passes them going round it: the cell on the left
/// of an edge, and a face turning counterclockwise seen from outside. On cells of positive Jacobian.
[[nodiscard]] const std::vector<std::vector<int>>& outward_facet_vertices(CellShape shape);

/// For each node the one at its mirror image when the first two reference axes are exchanged: the order in which the
/// nodes of a cell give it the opposite orientation. Not for intervals.
[[nodiscard]] const std::vector<int>& mirrored_nodes(CellShape shape, int degree);

/// Reference coordinates of a vertex, each 0 or 1.
[[nodiscard]] double vertex_coordinate(CellShape shape, int vertex, int axis);

}  // namespace ricochet
