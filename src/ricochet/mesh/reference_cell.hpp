#pragma once

#include <Eigen/Core>
#include <vector>

#include "ricochet/mesh/shapes/cell_shape.hpp"

/// @file Nodes and facets of the reference cells in Basix's numbering, described by vertices only.
namespace ricochet {

/// For each node of the Lagrange element of degree 1 or 2, the vertices (ascending) at whose mean it lies on a straight
/// cell: a vertex, the ends of an edge, the vertices of a quadrilateral face or of the whole quadrilateral or
/// hexahedron.
[[nodiscard]] const std::vector<std::vector<int>>& node_vertices(CellShape shape, int degree);

/// Number of nodes of the Lagrange element of degree 1 or 2 (the full one: 9 on a quadrilateral, 27 on a hexahedron).
[[nodiscard]] int node_count(CellShape shape, int degree);

/// Node of the element of degree 2 at the mean of these vertices, given in any order.
[[nodiscard]] int node_at_mean(CellShape shape, std::vector<int> vertices);

/// Degree of the Lagrange element with so many nodes, 1 or 2.
[[nodiscard]] int degree_of(CellShape shape, int nodes);

/// Shape of a facet, numbered in Basix's order. Throws std::logic_error if no shape has its number of vertices.
[[nodiscard]] CellShape facet_shape(CellShape shape, std::size_t facet);

/// For each facet of the cell, in Basix's order, the cell's nodes on it, in the order in which the facet itself numbers
/// its nodes. Empty for intervals.
[[nodiscard]] const std::vector<std::vector<int>>& facet_nodes(CellShape shape, int degree);

/// For each facet of a straight cell in Basix's order, its height in units of volume/area: d on simplices, 1 on
/// quadrilaterals and hexahedra.
[[nodiscard]] const std::vector<double>& facet_heights(CellShape shape);

/// For each facet of a cell with positive Jacobian, in Basix's order, its vertices in outward orientation: the cell is
/// on the left of an edge, and a face is counterclockwise seen from outside.
[[nodiscard]] const std::vector<std::vector<int>>& outward_facet_vertices(CellShape shape);

/// For each node its mirror image when the first two reference axes are exchanged: in this order the nodes of a cell
/// give it the opposite orientation. Not for intervals.
[[nodiscard]] const std::vector<int>& mirrored_nodes(CellShape shape, int degree);

/// Reference coordinates of the mean of some vertices; 0 beyond the dimension of the cell.
[[nodiscard]] Eigen::Vector3d reference_position(CellShape shape, const std::vector<int>& vertices);

/// For each node of a cell in a file of Gmsh, VTK or meshio, in the order there, its number in Basix's order.
[[nodiscard]] const std::vector<int>& gmsh_nodes(CellShape shape, int degree);
[[nodiscard]] const std::vector<int>& vtk_nodes(CellShape shape, int degree);
[[nodiscard]] const std::vector<int>& meshio_nodes(CellShape shape, int degree);

}  // namespace ricochet
