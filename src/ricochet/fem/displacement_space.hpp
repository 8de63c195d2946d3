#pragma once

#include <utility>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Finite element space of the displacement: Lagrange of degree 1 or 2, d components per node.
namespace ricochet {

/// Dof of component k at node i is i·dimension + k. Nodes are ordered by proximity (order_nodes) for good cache use in
/// products and assembly. Files and messages use other numbers (`number`).
struct DisplacementSpace {
  int dimension = 2;
  int degree = 1;
  Points nodes;                   ///< dimension × count, positions in the reference configuration
  std::vector<CellBlock> cells;   ///< blocks in the order of the mesh, with this space's nodes
  std::vector<CellBlock> facets;  ///< likewise
  /// Number of each node in files and messages, from 0: in the order of the mesh file (of its vertices if the degree is
  /// 1), followed by the nodes that degree 2 adds to a straight mesh.
  std::vector<Index> number;
  /// Pairs of nodes of different cells that belong to one body, because one of them is tied to the other.
  std::vector<std::pair<Index, Index>> glued = {};

  /// Number of nodes at the end that belong to no cell: those of rigid bodies (rigid/free_motion.hpp).
  Index nodes_without_cells = 0;

  [[nodiscard]] Index node_count() const { return nodes.cols(); }
  [[nodiscard]] Index cell_node_count() const { return nodes.cols() - nodes_without_cells; }
  [[nodiscard]] Index dof_count() const { return nodes.cols() * dimension; }
};

/// Diagonal of the bounding box of all nodes: only a scale for rounding errors, as it depends on the orientation of the
/// axes by up to a factor √d. base/point_sets.hpp has the sizes used for decisions and output.
[[nodiscard]] double extent(const Points& nodes);

/// Builds the space on a mesh whose geometry is of degree 1 or 2, independent of `degree`.
[[nodiscard]] DisplacementSpace make_displacement_space(const Mesh& mesh, int degree);

/// Block and local index of a facet or a cell that is numbered through all blocks.
[[nodiscard]] inline IndexInBlocks locate_facet(const DisplacementSpace& space, Index facet) {
  return locate_in_blocks(space.facets, facet);
}
[[nodiscard]] inline IndexInBlocks locate_cell(const DisplacementSpace& space, Index cell) {
  return locate_in_blocks(space.cells, cell);
}

/// Nodes of the given facets (numbered through all blocks), ascending and unique.
[[nodiscard]] std::vector<Index> facet_nodes(const DisplacementSpace& space, const std::vector<Index>& facets);

/// Node of a cell nearest to a point (of several the lowest in `number`), and its distance.
struct NearestNode {
  Index node = 0;
  double distance = 0.0;
};
[[nodiscard]] NearestNode nearest_node(const DisplacementSpace& space, const Vector& point);

}  // namespace ricochet
